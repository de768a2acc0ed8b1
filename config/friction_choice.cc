#include "config/friction_choice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "config/loop_axis.h"
#include "core/two_inertia_loop.h"
#include "drivers/cia402/mode_for.h"
#include "estimator/coarse_encoder.h"

namespace contour {
namespace {

// Measured on machines with modes of 40 to 400 Hz (docs/laboratory/family.md). In torque mode motor and table
// swing against each other: the filter's disturbance, fed back at some 170 Hz, rings with a mode below 300
// Hz.
constexpr double kLowestMode_Hz = 300.0;
// Measured at that cycle; in a longer one what is fed back is slower.
constexpr double kMeasuredAt_us = 1000.0;
// A drive that closes the loop holds the motor, and the table swings on the screw alone: from 92 Hz down
// circles are worse or the axis is lost, from 119 Hz up they are equal or better.
constexpr double kLowestOnHeldMotor_Hz = 110.0;

// At rest the filter's loop goes to and fro between two steps of the drive's torque, and the bristles by 0.4
// to 0.75 of what one step moves them. Held by a constant torque, as the linear law holds it, the axis
// stands.
constexpr double kLargestStepInWindUps = 0.5;
constexpr double kTorqueSteps = 1000.0;  // of rated torque, 0x6071

bool StepsMoveIt(const AxisConfig& config) {
  const LoopAxis axis = LoopAxisOf(config);
  const double level_N = 0.5 * (axis.friction.Fc_plus_N + axis.friction.Fc_minus_N);
  const double step_N = axis.rated_force_N / kTorqueSteps;
  return level_N > 0.0 &&
         step_N * axis.axis.stiffness_N_m > kLargestStepInWindUps * level_N * axis.friction.sigma0_N_m;
}

double OnHeldMotor_Hz(const TwoInertiaAxis& axis) {
  return std::sqrt(axis.stiffness_N_m / axis.table_mass_kg) / (2.0 * std::numbers::pi);
}

}  // namespace

bool ReportsAreNoise(const AxisConfig& config, double period_s) {
  const LoopAxis axis = LoopAxisOf(config);
  const double mass_kg = axis.axis.motor_mass_kg + axis.axis.table_mass_kg;
  return CountsHideFriction(axis.encoder_step_m, axis.friction, mass_kg, period_s);
}

bool FilterServes(const MachineConfig& machine) {
  const double lowest_mode_Hz = kLowestMode_Hz * std::min(1.0, kMeasuredAt_us / machine.machine.cycle_us);
  const double period_s = 1e-6 * machine.machine.cycle_us;
  for (const auto& [name, config] : machine.axes) {
    // The filter with one mass knows of no scale.
    if (config.drive.linear_scale) return false;
    const TwoInertiaAxis axis = TwoInertiaAxisOf(config);
    const bool held = ModeFor(ControllerName::kFull, config.drive) == DriveMode::kCsp;
    if (held ? OnHeldMotor_Hz(axis) < kLowestOnHeldMotor_Hz || ReportsAreNoise(config, period_s)
             : ModeFrequency_Hz(axis) < lowest_mode_Hz || StepsMoveIt(config))
      return false;
  }
  return true;
}

// In torque mode what the filter estimates is fed back, and no margin of that ring is known: with masses 30 %
// less than stated it swings after corners (docs/laboratory/robustness.md). The loop of the other law is
// designed with margins over all that an axis may be.
FrictionKind ChooseFriction(const MachineConfig& machine) {
  for (const auto& [name, config] : machine.axes)
    if (ModeFor(ControllerName::kFull, config.drive) == DriveMode::kCst) return FrictionKind::kLinear;
  return FilterServes(machine) ? FrictionKind::kSrukf : FrictionKind::kLinear;
}

}  // namespace contour
