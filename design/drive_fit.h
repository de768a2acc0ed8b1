#pragma once

#include <span>

#include "analysis/drive_loop/drive_record.h"
#include "analysis/drive_loop/drive_response.h"
#include "core/two_inertia_axis.h"
#include "design/drive_loop.h"

namespace contour {

/// A drive's loop from its measured response, on an axis that is known but for a factor on its masses and on
/// its stiffness.
struct DriveFit {
  DriveLoop loop;           ///< of its gains of position and of the integral the larger one is the position's
  TwoInertiaAxis axis;      ///< masses and stiffness as the response has them
  double error_rel = 0.0;   ///< median over the lines of |measured - model| / |measured|
  double highest_Hz = 0.0;  ///< of the lines that were used
  std::size_t lines = 0;
};
/// By the least squares of the relative error, whose scatter weighs each line, with the simplex search.
/// Throws std::runtime_error when there are too few lines to tell anything.
DriveFit FitDrive(const DriveResponse& response, const TwoInertiaAxis& axis, double period_s);

/// Of the torque of acceleration, what the drive does not give beside what it was sent: 0 where it feeds all
/// of it forward, 1 where none. From the following error on ramps, to which a missing force answers by the
/// loop that was found.
struct AccelerationShare {
  double missing = 0.0;
  double std = 0.0;  ///< one standard deviation
};
AccelerationShare MissingAcceleration(std::span<const DriveSample> samples, const TwoInertiaAxis& axis,
                                      const DriveLoop& loop, double period_s);

}  // namespace contour
