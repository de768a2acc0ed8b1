#pragma once

#include <string>
#include <vector>

namespace contour::test {

/// The example with control.friction: linear and the loops that `contour tune --from-model` found for it.
inline std::vector<std::string> TunedExample(const std::string& mode) {
  return {
      "control.friction=linear", "axes.x.drive.mode=" + mode, "axes.y.drive.mode=" + mode,
      "axes.x.loop={regulator_Hz: 26, windup_weight: 0.101, velocity_weight: 0.0386, disturbance_Hz: 270, "
      "motor_force_Hz: 1020, table_force_Hz: 1020, notch_ratio: 0.754, notch_pole_damping: 0.1, "
      "notch_zero_damping: 0.0465}",
      "axes.y.loop={regulator_Hz: 27.4, windup_weight: 0.0773, velocity_weight: 0.0604, disturbance_Hz: 274, "
      "motor_force_Hz: 1050, table_force_Hz: 476, notch_ratio: 0.751, notch_pole_damping: 0.103, "
      "notch_zero_damping: 0.0854}"};
}

}  // namespace contour::test
