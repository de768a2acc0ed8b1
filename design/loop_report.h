#pragma once

#include <string>
#include <vector>

#include "config/loop_axis.h"
#include "design/loop_margins.h"

namespace contour {

/// A loop of an axis for people: what `contour check` and `contour tune --from-model` print.
struct LoopReport {
  LoopVerdict verdict;
  LoopMargins sliding, rest;
};
LoopReport ReportOn(const LoopAxis& axis, const LoopTuning& tuning, double period_s);

/// Lines, each behind two spaces, without the axis's name.
std::string Describe(const LoopReport& report);

/// Of the table, at most, under the force step of the axis's `loop_limits`.
double Compliance_m_N(const LoopAxis& axis, const LoopReport& report);

/// What of it breaks a limit, in one sentence; empty when nothing does.
std::string WhatIsWrong(const LoopVerdict& verdict);

/// What would give an axis a loop that keeps its limits, tried on the model: another tuning, and where there
/// is none, a linear scale or a stiffer screw. That its drive may close the loop (csp) helps always.
std::vector<std::string> WhatWouldHelp(const LoopAxis& axis, double period_s, int threads);

}  // namespace contour
