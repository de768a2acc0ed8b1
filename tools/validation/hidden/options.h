#pragma once

#include <string>
#include <vector>

#include "tools/validation/hidden/question.h"

namespace contour::hidden {

struct Options {
  Plan plan;
  std::string record, judge, keep, out, evidence, sizes;
  std::vector<std::string> only;  ///< beginnings of the names of the cases to judge; empty: all
  double rate = 0.05;
  double strict_rate = 0.0;  ///< clean machines that raise an alarm are asked again at this rate; 0: not
  int bootstrap = 0;
  unsigned threads = 1;
  bool compact = false;  ///< logs as tables
  bool fit_above_chance = false;
  bool verbose = false;
};

/// Ends the program with status 2 and a message when something is wrong, with 0 after --help.
Options ParseOptions(int argc, char** argv);

}  // namespace contour::hidden
