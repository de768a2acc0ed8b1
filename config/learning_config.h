#pragma once

#include <cstdint>

#include "core/visit.h"

namespace contour {

/// `learning:` of a machine file: programs that run again and again are learnt from pass to pass.
struct LearningConfig {
  bool enabled = false;
  double gain = 0.6;
  double bandwidth_Hz = 40.0;
  double largest_um = 20.0;
  double longest_s = 600.0;
  std::int32_t programs = 4;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("enabled", enabled,
               "learn from each pass of a program what its next pass is told in advance; every axis needs "
               "drive.linear_scale");
    v.Optional("gain", gain, Range{0.05, 1.0}, "share of the error that the next pass makes up for");
    v.Optional("bandwidth_Hz", bandwidth_Hz, Range{1.0, 200.0}, "faster errors are not learnt");
    v.Optional("largest_um", largest_um, Range{0.1, 200.0},
               "a reference is shifted by this at most; programs keep so far off the position limits");
    v.Optional("longest_s", longest_s, Range{1.0, 3600.0}, "longer programs are not learnt");
    v.Optional("programs", programs, Range{1, 64}, "remembered at a time, those that ran last");
  }
};

}  // namespace contour
