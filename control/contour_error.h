#pragma once

#include <cstddef>

#include "core/axis.h"
#include "core/horizon.h"

namespace contour {

struct ContourError {
  double contour_m = 0.0;  ///< shortest distance to the path nearby
  double lag_m = 0.0;      ///< behind the reference along its direction of motion; negative ahead; 0 at rest
  double nearest_periods = 0.0;  ///< where the nearest point lies, periods from the reference point
};

/// Error of a position against the path through the reference points. Element `now` of the horizons is the
/// reference at the position's instant; elements before it, if there are any, are the path's recent past
/// (without them it is continued backwards by velocity and acceleration). Looks as far along the path as the
/// distance to the reference allows, at most 16 periods. Pure; any number of axes.
ContourError FindContourError(const PerAxis<double>& position_m, const PerAxis<AxisHorizon>& reference,
                              double period_s, std::size_t now = 0) noexcept;

}  // namespace contour
