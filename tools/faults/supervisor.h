#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/rt/cycle_config.h"

namespace contour::faults {

/// A supervisor that --without can switch off, to show that the campaign misses it.
struct Supervisor {
  std::string_view name;
  std::string_view what;
  void (*off)(CycleConfig&);
};
const std::vector<Supervisor>& Supervisors();
/// Null when there is none of that name.
const Supervisor* FindSupervisor(std::string_view name);

}  // namespace contour::faults
