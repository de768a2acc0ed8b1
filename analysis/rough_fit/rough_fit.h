#pragma once

#include <cstddef>
#include <string>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/recording/axis_log.h"

namespace contour::diagnosis {

/// Of a log, for deviations by what its parts say: many enough to tell them to a sixth.
inline constexpr std::size_t kPartsOfLog = 20;

/// What a rigid axis with Coulomb and viscous friction would be by least squares on the smoothed log: good
/// enough to begin with.
struct RoughFit {
  std::string why_not;  ///< nothing was found; empty: found
  double inertia = 0.0;
  double inertia_sigma_rel = 0.0;
  double inflation = 1.0;  ///< of the inertia's variance by what else moves like the acceleration
  double coulomb = 0.0, viscous = 0.0;
  double coulomb_forth = 0.0, coulomb_back = 0.0;  ///< of each direction; 0 where it never slides so
  double coulomb_sigma = 0.0;
  /// The same relative deviations by what the parts of the log say: what the axis does beyond the equation
  /// goes on for longer than a row, and differs from part to part.
  double inertia_by_parts = 0.0, coulomb_by_parts = 0.0, viscous_by_parts = 0.0;
  double unexplained = 1.0;    ///< share of the command's square
  bool one_direction = false;  ///< it never slides in the other
  double max_speed = 0.0;      ///< of q
  double travel = 0.0;         ///< between the extremes of q
  double middle = 0.0;         ///< of them
  double visits = 0.0;         ///< so often the axis comes to half of the places between them, or more often
  double typical = 0.0;        ///< root mean square of the command
};

/// [share of the command's square] With more that the motion does not explain, least squares say little.
inline constexpr double kMostUnexplained = 0.25;

enum class RoughShape { kFriction, kFrictionAndSpring };

/// In the units of the log's command. With a force that grows with the position (a spring, a joint's
/// weight) an inertia is only known as far as it is not the same: on one sine it is.
/// `falling`: friction whose break-away part, as it is there, is taken out first; the rest knows none that
/// falls with the speed.
RoughFit FitRoughly(const AxisLog& log, const StatedAxis& stated, RoughShape shape = RoughShape::kFriction,
                    const StatedFriction* falling = nullptr);

}  // namespace contour::diagnosis
