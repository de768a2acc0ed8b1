#pragma once

#include <limits>
#include <optional>
#include <string>

#include "config/loop_axis.h"
#include "control/standstill.h"
#include "design/creep.h"
#include "design/loop_margins.h"

namespace contour {

/// A screw that may be stiffer than stated, at rest. A loop without a scale leads its motor by F / K; of that
/// the true screw takes F / K_true, and bristles answer the rest with sigma0 times it: from sigma0 (1 / K - 1
/// / K_true) = 1 on the table hunts. F and sigma0 are the table's, without the motor's share.
struct RestingScrew {
  double stated_N_m = 0.0;
  double stated_std = 0.0;  ///< relative
  double stable_below_N_m = std::numeric_limits<double>::infinity();
};
RestingScrew RestingScrewOf(const LoopAxis& axis);

/// A loop of an axis for people: what `contour check` and `contour tune --from-model` print.
struct LoopReport {
  LoopVerdict verdict;
  LoopMargins sliding, rest;
  /// Where friction leaves no margin on the whole UncertaintySet: the verdict is on CreepingSet, if that has
  /// one.
  std::optional<StickSlip> stick_slip;
  /// Where every limit is kept and a force is not taken up: what friction makes of that after a stop.
  std::optional<StickSlip> after_stops;
  RestingAxis resting;  ///< as the cycle holds it
  RestingScrew screw;
};
LoopReport ReportOn(const LoopAxis& axis, const LoopTuning& tuning, double period_s);

/// Lines, each behind two spaces, without the axis's name.
std::string Describe(const LoopReport& report);

/// Of the table, at most, under the force step of the axis's `loop_limits`.
double Compliance_m_N(const LoopAxis& axis, const LoopReport& report);

/// What of it breaks a limit, in one sentence; empty when nothing does.
std::string WhatIsWrong(const LoopVerdict& verdict);
std::string WhatIsWrong(const LoopReport& report);

}  // namespace contour
