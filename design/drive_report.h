#pragma once

#include <optional>
#include <string>

#include "design/drive_fit.h"
#include "design/drive_loop.h"

namespace contour {

/// What was measured of a drive's loop, and what it does on its axis.
struct DriveReport {
  std::string axis;
  DriveFit fit;
  DriveLoopFigures figures;
  AccelerationShare acceleration;
  double given_share = 0.0;  ///< csp_acceleration_share while it was measured
  double step_N = 0.0;       ///< a tenth of the rated force
  double count_m = 0.0;      ///< of the drive's encoder, as travel of the table
  double kick_N = 0.0;       ///< rms of what counts that flicker make its loop push by
  double friction_N = 0.0;   ///< Coulomb level, as the model states it
  /// The table under the same force with torques from here (cst), where the axis has a loop for it.
  std::optional<double> torque_mode_peak_m;
};

/// Lines for people.
std::string Describe(const DriveReport& report);

/// What to do about it, a sentence each: keys, and gains of the drive.
std::string Advice(const DriveReport& report);

/// Of the torque of acceleration, the share that the drive should be given: csp_acceleration_share.
double AdvisedShare(const DriveReport& report);

/// Whether the measurement is one. Empty, or the reason and what to do.
std::string WhyUnusable(const DriveFit& fit);

}  // namespace contour
