#pragma once

#include <string>
#include <vector>

#include "config/loop_axis.h"

namespace contour {

/// What would give an axis a loop that keeps its limits, tried on the model with both searches of FindLoop:
/// another tuning, and where there is none, a linear scale or a stiffer screw; with a word where its table
/// would stick and slip all the same. That its drive may close the loop (csp) helps always.
/// `searched`: another tuning was looked for at length.
std::vector<std::string> WhatWouldHelp(const LoopAxis& axis, double period_s, int threads,
                                       bool searched = false);

}  // namespace contour
