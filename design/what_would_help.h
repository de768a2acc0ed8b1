#pragma once

#include <string>
#include <vector>

#include "config/loop_axis.h"

namespace contour {

/// Said where nobody waits for what WhatWouldHelp tries.
inline constexpr const char* kWhoTries = "contour check tries other tunings, scales and screws";
/// Helps always.
inline constexpr const char* kDriveCloses = "drive.mode: csp, in which the drive closes the loop";

/// What would give an axis a loop that keeps its limits, tried on the model with both searches of FindLoop:
/// another tuning, and where there is none, a linear scale or a stiffer screw; with a word where its table
/// would stick and slip all the same. That its drive may close the loop (csp) helps always.
/// `searched`: another tuning was looked for at length. Takes up to some ten seconds for an axis.
std::vector<std::string> WhatWouldHelp(const LoopAxis& axis, double period_s, int threads,
                                       bool searched = false);

}  // namespace contour
