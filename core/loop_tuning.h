#pragma once

#include "core/visit.h"

namespace contour {

/// Tuning of the two-inertia loop of one axis, `axes.<name>.loop` of a machine file. `contour tune
/// --from-model` finds it from the axis's model (docs/tuning_from_model.md); nobody types it. Frequencies and
/// ratios, so that a number means the same on an axis of any mass.
struct LoopTuning {
  double regulator_Hz = 0.0;
  double windup_weight = 0.0;
  double velocity_weight = 0.0;
  double disturbance_Hz = 0.0;
  double motor_force_Hz = 0.0;
  double table_force_Hz = 0.0;
  double notch_ratio = 0.0;
  double notch_pole_damping = 0.0;
  double notch_zero_damping = 0.0;
  double scale_noise_ratio = 1.0;
  double bias_Hz = 5.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("regulator_Hz", regulator_Hz, kPositive,
               "weight of the table's position against torque, as the natural frequency of a rigid axis");
    v.Required("windup_weight", windup_weight, kNotNegative,
               "weight of the screw's rate of wind-up against regulator_Hz times the position");
    v.Required("velocity_weight", velocity_weight, kNotNegative,
               "weight of the table's velocity against regulator_Hz times the position");
    v.Required("disturbance_Hz", disturbance_Hz, kPositive,
               "how fast the observer lets a force on the table change");
    v.Required("motor_force_Hz", motor_force_Hz, kPositive,
               "how far the observer trusts the motor's equation of motion");
    v.Required("table_force_Hz", table_force_Hz, kPositive,
               "how far the observer trusts the table's equation of motion");
    v.Required("notch_ratio", notch_ratio, kPositive,
               "frequency of the torque filter, in that of the screw's mode");
    v.Required("notch_pole_damping", notch_pole_damping, kPositive, "damping of the torque filter's poles");
    v.Required("notch_zero_damping", notch_zero_damping, kPositive, "damping of the torque filter's zeros");
    v.Optional("scale_noise_ratio", scale_noise_ratio, kPositive,
               "noise of the linear scale in that of the encoder, as the observer weighs them");
    v.Optional("bias_Hz", bias_Hz, kPositive,
               "how fast the observer lets encoder and linear scale drift apart");
  }
};

}  // namespace contour
