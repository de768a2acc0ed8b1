#pragma once

#include <functional>

namespace contour {

/// The canned cycles that move in a straight line along one axis: G73, G81, G82, G83, G85 and G89, tenfold.
/// The others turn or stop the spindle, or are turning cycles.
[[nodiscard]] bool IsDrillingCycle(int motion);
/// Needs P, a dwell at the bottom.
[[nodiscard]] bool DwellsInCycle(int motion);
/// Needs Q, how deep each peck is.
[[nodiscard]] bool PecksInCycle(int motion);

/// What a series of cycles keeps from one hole to the next, in metres along the drilled axis.
struct DrillingCycle {
  int motion = 0;         ///< 0: no series
  double level_m = 0.0;   ///< where the axis stood before the series, from program zero
  double clear_m = 0.0;   ///< R, as stated
  double bottom_m = 0.0;  ///< Z, as stated
  double peck_m = 0.0;
  double dwell_s = 0.0;
};

/// One hole's places along the drilled axis, from program zero.
struct Hole {
  double clear_m = 0.0;
  double bottom_m = 0.0;
  double retract_m = 0.0;  ///< where it ends
};

struct DrillingStroke {
  enum class Kind { kRapid, kFeed, kDwell };
  Kind kind = Kind::kRapid;
  double to_m = 0.0;
};

/// That a program may have: as many as the lines that its O words may run through.
inline constexpr double kMostStrokes = 5e6;

/// How many moves a hole takes, those to its clearance plane with them.
[[nodiscard]] double StrokesOf(const DrillingCycle& cycle, const Hole& hole);

/// The strokes from the clearance plane on, one after the other.
void Drill(const DrillingCycle& cycle, const Hole& hole,
           const std::function<void(const DrillingStroke&)>& sink);

}  // namespace contour
