#pragma once

#include <string>
#include <vector>

#include "config/machine_config.h"

namespace contour {

/// A key that two configurations have different values for.
struct ConfigDifference {
  std::string key;  ///< dotted
  std::string was;  ///< as text; empty where one of them does not have it
  std::string now;
};

/// Every key of a machine file that differs, defaults included, in the order of the reference of keys.
std::vector<ConfigDifference> Differences(const MachineConfig& was, const MachineConfig& now);

/// What may change while the machine runs: gains of the controllers. Everything else is built into the cycle,
/// the drives or the threads when contourd starts.
bool MayChangeWhileRunning(const std::string& key);

}  // namespace contour
