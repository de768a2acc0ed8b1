#pragma once

#include <string>
#include <vector>

#include "config/machine_config.h"

namespace contour {

/// The command line of contourd.
struct DaemonOptions {
  std::string config;
  std::vector<std::string> buses;  ///< interfaces instead of the machine file's, in the order of its buses
  std::string clock = "wall";      ///< or "lockstep"
  std::string controller;          ///< empty: the machine file's
  std::vector<std::string> set;
  std::vector<std::string> models;  ///< AXIS=YAML, in place of the machine file's; the last of an axis counts
  std::vector<std::string>
      torque_loops;  ///< AXIS=YAML of all axes: torque mode with these; empty: as the file
  std::vector<std::string> torque_models;  ///< AXIS=YAML, in torque mode in place of the axis's own
  std::vector<std::string> csp_axes;       ///< all axes: csp; empty: as the file
  std::string log;                         ///< empty: none
  std::string truth;                       ///< empty: none; loopback only
  std::string socket;                      ///< empty: the default place
};

enum class ParseResult { kRun, kDone, kBadUsage };
/// Help and version are printed, mistakes reported on stderr.
ParseResult ParseOptions(int argc, char** argv, DaemonOptions& options);

}  // namespace contour
