#include "daemon/program/gcode/drilling_cycle.h"

#include <algorithm>
#include <cmath>

namespace contour {
namespace {

// Of LinuxCNC: how far a drill goes back to break a chip (G73), or stays above the ground it has cut (G83).
constexpr double kAboveGround_m = 0.254e-3;

// Two across and down to the clearance plane, the last feed and the way back.
constexpr double kStrokesOfAHole = 4.0;

}  // namespace

bool IsDrillingCycle(int motion) {
  return motion == 730 || motion == 810 || motion == 820 || motion == 830 || motion == 850 || motion == 890;
}

bool DwellsInCycle(int motion) { return motion == 820 || motion == 890; }

bool PecksInCycle(int motion) { return motion == 730 || motion == 830; }

double StrokesOf(const DrillingCycle& cycle, const Hole& hole) {
  const double more = DwellsInCycle(cycle.motion) || cycle.motion == 850 ? 1.0 : 0.0;
  if (!PecksInCycle(cycle.motion)) return kStrokesOfAHole + more;
  const double pecks = std::max(0.0, std::ceil((hole.clear_m - hole.bottom_m) / cycle.peck_m) - 1.0);
  return kStrokesOfAHole + (cycle.motion == 830 ? 3.0 : 2.0) * pecks;
}

void Drill(const DrillingCycle& cycle, const Hole& hole,
           const std::function<void(const DrillingStroke&)>& sink) {
  using Kind = DrillingStroke::Kind;
  if (PecksInCycle(cycle.motion)) {
    // By counting, so that no depth is summed up.
    for (int n = 1; hole.clear_m - n * cycle.peck_m > hole.bottom_m; ++n) {
      const double depth_m = hole.clear_m - n * cycle.peck_m;
      sink({Kind::kFeed, depth_m});
      if (cycle.motion == 830) sink({Kind::kRapid, hole.clear_m});
      sink({Kind::kRapid, depth_m + kAboveGround_m});
    }
  }
  sink({Kind::kFeed, hole.bottom_m});
  if (DwellsInCycle(cycle.motion)) sink({Kind::kDwell, hole.bottom_m});
  if (cycle.motion == 850) sink({Kind::kFeed, hole.clear_m});
  sink({cycle.motion == 890 ? Kind::kFeed : Kind::kRapid, hole.retract_m});
}

}  // namespace contour
