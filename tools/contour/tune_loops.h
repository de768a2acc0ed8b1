#pragma once

#include <string>

namespace contour {

struct TuneLoopsOptions {
  std::string machine;  ///< file
  std::string axis;     ///< empty: all of them
  std::string out;      ///< machine file to write; empty: print only
  unsigned threads = 0;
  int evaluations = 0;     ///< of each run of the search; 0: its own
  bool catalogue = false;  ///< loops to commission with, for all that the model leaves open
};

/// `contour tune --from-model`: the two-inertia loop of each axis from its model. Returns the exit status.
int TuneLoops(const TuneLoopsOptions& options);

}  // namespace contour
