#pragma once

#include <optional>
#include <vector>

#include "daemon/program/corner_blend.h"
#include "daemon/program/path_runs.h"

namespace contour {

/// Where two runs of a program with blended corners meet.
struct BlendedJunction {
  std::optional<CornerBlend> blend;  ///< none: the path passes as it is, or stops
  PassingState state;                ///< of either run where it ends or begins
  double cut_m = 0.0;                ///< taken off either run by the blend
};

/// How far the path itself may leave the programmed one where the machine shall keep within `tolerance_m`:
/// what is left is for following it. The time that a blend saves goes with the cube root of its deviation, so
/// that being generous costs little.
double BlendDeviation_m(double tolerance_m, const PerAxis<PlanLimits>& limits);

/// Which share of the axes' acceleration and jerk keeps the table within what is then left for following, as
/// far as inertia goes that the screw is not known well enough for; no less than is as good as friction lets
/// it be.
double FollowedShare(double tolerance_m, const PerAxis<PlanLimits>& limits);

/// Blends need a limit of jerk; for axes without one it is what brings them to full acceleration within four
/// milliseconds.
PerAxis<PlanLimits> WithJerk(PerAxis<PlanLimits> limits);

/// What happens between the runs (element i lies before run i): a blend at every corner between straight
/// pieces that asks for one, slowed down until every run is long enough for its change of speed. The runs'
/// limits and `limits` have a jerk above zero.
std::vector<BlendedJunction> BlendedJunctions(const std::vector<RunRequest>& runs,
                                              const std::vector<PieceRequest>& requests,
                                              const PerAxis<PlanLimits>& limits);

}  // namespace contour
