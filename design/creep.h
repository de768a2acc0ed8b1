#pragma once

#include <vector>

#include "config/loop_axis.h"
#include "core/two_inertia_loop.h"
#include "design/loop_margins.h"

namespace contour {

/// Of the error under a step of force, 200 ms after it. A loop that only holds against a force bears
/// friction's slope best, leaves the table beside its path by all that is not known of friction, and hunts,
/// on an axis that creeps too slowly for CreepAt to see. Where nothing creeps CreepAt tells whether it hunts.
inline constexpr double kMostLeft = 0.1;
[[nodiscard]] inline bool TakesUp(const ForceStep& step, double tolerance = 0.0) {
  return step.left_m <= kMostLeft * step.peak_m * (1.0 + tolerance);
}

/// What is asked of an axis after a program: that it stands so long after. Until then it may settle; what
/// holds an axis at rest (control/standstill.h) takes the rest of a slow settling, but not of a table that
/// runs on.
inline constexpr double kStandsAfter_s = 3.0;

/// Of a table that creeps at one speed and then stops: from top to bottom of its error, once it has settled.
struct Creep {
  double speed_m_s = 0.0;
  double swing_m = 0.0;  ///< while it creeps
  double stop_m = 0.0;   ///< from kStandsAfter_s after its reference has come to stand
  double rest_m = 0.0;   ///< once what settles slowest has
};

/// How long an axis is looked at: what settles slowest at this speed, and at rest with its table held by the
/// bristles (which hide a loop's integral action from the axis), must have settled or grown before. At rest
/// not less than kStandsAfter_s.
struct CreepTimes {
  double creeps_s = 0.0;
  double looks_creeping_s = 0.0;  ///< after it
  double rests_s = 0.0;
  double looks_resting_s = 0.0;
};
CreepTimes TimesOf(const LoopAxis& axis, const TwoInertiaLoop& loop, double period_s, double speed_m_s);

/// From a steady speed that is kicked by as much as the bristles bend. Motor and table with LuGre friction of
/// `friction_rel` times what is stated, the steady force of it fed forward, nothing learnt, and without what
/// holds an axis at rest (control/standstill.h). A linear loop on friction's falling slope tells whether the
/// table leaves a steady speed; this tells where that ends.
Creep CreepAt(const LoopAxis& axis, const TwoInertiaLoop& loop, double period_s, double speed_m_s,
              double friction_rel = 1.0);

/// What friction's falling slope does to an axis, at worst, with friction as stated and off by what it is
/// uncertain.
struct StickSlip {
  double swing_m = 0.0;  ///< largest while it creeps
  double at_m_s = 0.0;   ///< and at which speed
  // Where it sticks: where it swings by more than the bristles bend. No range: nowhere.
  double slowest_m_s = 0.0, fastest_m_s = 0.0;
  double stop_m = 0.0;       ///< largest from kStandsAfter_s after the stop: it settles too slowly
  double most_stop_m = 0.0;  ///< by which it may
  double rest_m = 0.0;       ///< largest once it has settled: it hunts
  double most_rest_m = 0.0;  ///< by which it may
  [[nodiscard]] bool Sticks() const { return fastest_m_s > 0.0; }
  [[nodiscard]] bool Settles() const { return stop_m <= most_stop_m; }
  [[nodiscard]] bool ComesToRest() const { return Settles() && rest_m <= most_rest_m; }
};
StickSlip StickSlipOf(const LoopAxis& axis, const TwoInertiaLoop& loop, double period_s);

/// The same, but no longer than until it is seen that the table does not come to rest: seconds, else.
StickSlip RestAfterStops(const LoopAxis& axis, const TwoInertiaLoop& loop, double period_s);

}  // namespace contour
