#pragma once

#include <string>

#include "tools/faults/fault_case.h"

namespace contour::faults {

struct Options {
  std::string config = "config/xy_emulated.yaml";
  PlanRequest plan;
  std::string without;
  unsigned threads = 1;
  std::string out;
  bool supervisors = false;  ///< show what each supervisor is good for
  bool list = false;         ///< only say what there is
  bool verbose = false;
};

/// Ends the program by itself after --help, --version and bad usage.
Options ParseOptions(int argc, char** argv);

}  // namespace contour::faults
