#pragma once

#include <optional>
#include <string>

#include "config/loop_axis.h"
#include "control/standstill.h"
#include "design/creep.h"
#include "design/loop_margins.h"

namespace contour {

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
