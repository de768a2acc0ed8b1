#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "config/machine_config.h"
#include "core/loop_limits.h"
#include "core/side_mode.h"
#include "core/two_inertia_axis.h"
#include "estimator/friction_config.h"

namespace contour {

/// All that the design of an axis's loop goes by, SI units at the table.
struct LoopAxis {
  TwoInertiaAxis axis;
  Friction friction;
  double rated_force_N = 0.0;
  double most_force_N = std::numeric_limits<double>::infinity();  ///< that the axis's torque limit leaves
  double encoder_step_m = 0.0;
  std::optional<double> scale_step_m;  ///< of the linear scale, where the loop has one
  LoopLimits limits;
  // Relative, one standard deviation.
  double stiffness_std = 0.0;
  double motor_mass_std = 0.0;
  double table_mass_std = 0.0;
  double motor_share_std = 0.0;  ///< of friction.motor_share, absolute
  double friction_std = 0.0;     ///< of all of it
  std::vector<SideMode> side_modes;
};

/// The axis as the cycle's loop runs on it, with the model's extensions: what is judged is what runs.
TwoInertiaAxis TwoInertiaAxisOf(const AxisConfig& axis);

/// As the machine file states it, extensions of the model included, for the loop that goes by the motor.
LoopAxis LoopAxisOf(const AxisConfig& axis);
/// The same for the loop that goes by the linear scale as well; none where the drive has none.
std::optional<LoopAxis> ScaleLoopAxisOf(const AxisConfig& axis);

/// The stiffest spring by which an experiment can hold the axis, where the file has its loop: what holds with
/// and without its scale. Infinite without a loop, and of one that cannot be.
double StiffestSpring_N_m(const AxisConfig& axis, double period_s);

/// By how much its screw gives under the force step of `loop_limits`.
double WindUpUnderForceStep_m(const AxisConfig& axis);
/// Of the axis whose screw gives most.
double WindUpUnderForceStep_m(const MachineConfig& machine);

/// Of a program that states none, on a machine that is expected to be `following_mm` off its path.
double PathTolerance_mm(const MachineConfig& machine, double following_mm);

}  // namespace contour
