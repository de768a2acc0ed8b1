#pragma once

#include <optional>
#include <vector>

#include "core/visit.h"

// `model.extensions`: effects that the basic model leaves out, as diagnosis finds them. Kinds and parameters
// have the names that diagnosis reports. Torques act on the motor and accelerate towards positive position
// when positive; positions are the table's, angles the motor's, both as the drive reports them.
namespace contour {

/// Coulomb levels that differ between the directions, break-away levels with them, more than the model
/// states.
struct AsymmetricCoulombExtension {
  double difference_rel = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("difference_rel", difference_rel, Range{-1.9, 1.9},
               "(Fc_plus - Fc_minus) / mean, added to the model's");
  }
};

struct ConstantTorqueExtension {
  double torque_Nm = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("torque_Nm", torque_Nm, kAny, "always there, on the motor");
  }
};

/// In place of the model's break-away levels and Stribeck velocity.
struct StribeckExtension {
  double Fs_over_Fc = 1.0;
  double vs_rad_s = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("Fs_over_Fc", Fs_over_Fc, Range{1.0, 10.0}, "break-away over Coulomb level, both directions");
    v.Required("vs_rad_s", vs_rad_s, kPositive, "Stribeck velocity at the motor");
  }
};

/// Friction level along the stroke: 1 + friction_rel times the model's. Straight lines between the points.
struct PositionFrictionExtension {
  double amplitude_rel = 0.0;
  std::vector<double> position_mm;
  std::vector<double> friction_rel;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("amplitude_rel", amplitude_rel, kNotNegative, "half of highest minus lowest, for people");
    v.Required("position_mm", position_mm, "positions of the table, ascending");
    v.Required("friction_rel", friction_rel, Range{-0.95, 10.0},
               "friction beyond the model's there, relative");
  }
};

/// A force that depends on the position alone.
struct CableSpringExtension {
  double torque_at_stroke_end_Nm = 0.0;
  std::vector<double> position_mm;
  std::vector<double> torque_Nm;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("torque_at_stroke_end_Nm", torque_at_stroke_end_Nm, kAny, "of the table, for people");
    v.Required("position_mm", position_mm, "positions of the table, ascending");
    v.Required("torque_Nm", torque_Nm, "torque there");
  }
};

struct RippleWave {
  double amplitude_rel = 0.0;
  double order_per_rev = 1.0;
  double phase_rad = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("amplitude_rel", amplitude_rel, Range{-0.95, 0.95}, "peak, of the friction level");
    v.Required("order_per_rev", order_per_rev, kPositive, "periods per motor turn");
    v.Required("phase_rad", phase_rad, kAny, "phase at motor angle zero, of the sine");
  }
};

/// friction_ripple and ball_ripple: 1 + the sum of amplitude_rel sin(order_per_rev theta + phase_rad) times
/// the friction level.
struct RippleExtension : RippleWave {
  std::vector<RippleWave> further;
  template <class Visitor>
  void Visit(Visitor& v) {
    RippleWave::Visit(v);
    v.Optional("further", further, "waves of other orders beside it");
  }
};

struct CoggingWave {
  double amplitude_Nm = 0.0;
  double order_per_rev = 1.0;
  double phase_rad = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("amplitude_Nm", amplitude_Nm, kAny, "peak torque");
    v.Required("order_per_rev", order_per_rev, kPositive, "periods per motor turn");
    v.Required("phase_rad", phase_rad, kAny, "phase at motor angle zero, of the sine");
  }
};

/// The sum of amplitude_Nm sin(order_per_rev theta + phase_rad).
struct CoggingExtension : CoggingWave {
  std::vector<CoggingWave> further;
  template <class Visitor>
  void Visit(Visitor& v) {
    CoggingWave::Visit(v);
    v.Optional("further", further, "waves of other orders beside it");
  }
};

/// Friction beyond the linear term, with u = |w| / max_speed_rad_s: torque_at_max_speed_Nm u^exponent; with a
/// knee, k = knee_rad_s / max_speed_rad_s, torque_at_max_speed_Nm u (1 + k) / (u + k).
struct ViscousCurve {
  double torque_at_max_speed_Nm = 0.0;
  double max_speed_rad_s = 0.0;
  double exponent = 2.0;
  double knee_rad_s = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("torque_at_max_speed_Nm", torque_at_max_speed_Nm, kAny,
               "friction beyond the linear term there");
    v.Required("max_speed_rad_s", max_speed_rad_s, kPositive, "the speed it is stated for");
    v.Optional("exponent", exponent, Range{0.1, 4.0}, "power of the speed");
    v.Optional("knee_rad_s", knee_rad_s, kNotNegative, "speed from which it hardly grows; 0: the power law");
  }
};

/// The sum of the curves.
struct ViscousNonlinearExtension : ViscousCurve {
  std::vector<ViscousCurve> further;
  template <class Visitor>
  void Visit(Visitor& v) {
    ViscousCurve::Visit(v);
    v.Optional("further", further, "curves beside it");
  }
};

/// sigma2 times 1 + difference_rel / 2 upwards, 1 - difference_rel / 2 downwards.
struct AsymmetricViscousExtension {
  double difference_rel = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("difference_rel", difference_rel, Range{-1.9, 1.9},
               "(upwards - downwards) / mean of the viscous coefficient");
  }
};

/// sigma2 times 1 + rate_1_K (T - reference_degC).
struct TemperatureViscosityExtension {
  double rate_1_K = 0.0;
  double reference_degC = 20.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("rate_1_K", rate_1_K, Range{-0.2, 0.2}, "relative change of viscous friction per kelvin");
    v.Required("reference_degC", reference_degC, Range{-50, 150}, "temperature that sigma2 is stated for");
  }
};

/// The motor gives ratio times the torque that is asked for.
struct TorqueConstantExtension {
  double ratio = 1.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("ratio", ratio, Range{0.2, 5.0}, "true over stated torque");
  }
};

/// In place of the model's screw stiffness and damping.
struct ComplianceExtension {
  double antiresonance_Hz = 0.0;
  double stiffness_Nm_rad = 0.0;
  double damping_ratio = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("antiresonance_Hz", antiresonance_Hz, kNotNegative, "of the table on the screw, for people");
    v.Required("stiffness_Nm_rad", stiffness_Nm_rad, kPositive, "between motor and table, seen at the motor");
    v.Required("damping_ratio", damping_ratio, Range{0.0, 2.0}, "of the resonance");
  }
};

struct InputDelayExtension {
  double delay_us = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("delay_us", delay_us, Range{-2000.0, 20000.0}, "added to the drive's delay");
  }
};

struct CurrentLagExtension {
  double time_constant_us = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("time_constant_us", time_constant_us, Range{-2000.0, 20000.0}, "added to the drive's lag");
  }
};

/// The table stands error_um beyond R theta. Straight lines between the points.
struct PitchErrorExtension {
  double amplitude_um = 0.0;
  std::vector<double> position_mm;
  std::vector<double> error_um;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("amplitude_um", amplitude_um, kNotNegative, "half of highest minus lowest, for people");
    v.Required("position_mm", position_mm, "positions of the table, ascending");
    v.Required("error_um", error_um, "true position minus R theta there");
  }
};

struct WobbleWave {
  double amplitude_um = 0.0;
  double order_per_rev = 1.0;
  double phase_rad = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("amplitude_um", amplitude_um, kAny, "peak");
    v.Required("order_per_rev", order_per_rev, kPositive, "periods per motor turn");
    v.Required("phase_rad", phase_rad, kAny, "phase at motor angle zero, of the sine");
  }
};

/// The table stands the sum of amplitude_um sin(order_per_rev theta + phase_rad) beyond R theta.
struct LeadWobbleExtension : WobbleWave {
  std::vector<WobbleWave> further;
  template <class Visitor>
  void Visit(Visitor& v) {
    WobbleWave::Visit(v);
    v.Optional("further", further, "waves of other orders beside it");
  }
};

/// `model.extensions`.
struct ExtensionsConfig {
  std::optional<AsymmetricCoulombExtension> asymmetric_coulomb;
  std::optional<ConstantTorqueExtension> constant_torque;
  std::optional<StribeckExtension> stribeck;
  std::optional<PositionFrictionExtension> position_friction;
  std::optional<CableSpringExtension> cable_spring;
  std::optional<RippleExtension> friction_ripple;
  std::optional<RippleExtension> ball_ripple;
  std::optional<CoggingExtension> cogging;
  std::optional<ViscousNonlinearExtension> viscous_nonlinear;
  std::optional<AsymmetricViscousExtension> asymmetric_viscous;
  std::optional<TemperatureViscosityExtension> temperature_viscosity;
  std::optional<TorqueConstantExtension> torque_constant;
  std::optional<ComplianceExtension> compliance;
  std::optional<InputDelayExtension> input_delay;
  std::optional<CurrentLagExtension> current_lag;
  std::optional<PitchErrorExtension> pitch_error;
  std::optional<LeadWobbleExtension> lead_wobble;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("asymmetric_coulomb", asymmetric_coulomb,
               "friction levels that differ between the directions");
    v.Optional("constant_torque", constant_torque, "gravity or a sensor offset");
    v.Optional("stribeck", stribeck, "another Stribeck curve");
    v.Optional("position_friction", position_friction, "friction along the stroke");
    v.Optional("cable_spring", cable_spring, "a force along the stroke");
    v.Optional("friction_ripple", friction_ripple, "friction that varies per turn");
    v.Optional("ball_ripple", ball_ripple, "friction that varies with the balls' circulation");
    v.Optional("cogging", cogging, "detent torque");
    v.Optional("viscous_nonlinear", viscous_nonlinear, "viscous friction beyond the linear term");
    v.Optional("asymmetric_viscous", asymmetric_viscous,
               "viscous friction that differs between the directions");
    v.Optional("temperature_viscosity", temperature_viscosity,
               "viscous friction that changes with temperature");
    v.Optional("torque_constant", torque_constant, "torque constant other than stated");
    v.Optional("compliance", compliance, "another stiffness of the screw");
    v.Optional("input_delay", input_delay, "delay of the command beyond the stated one");
    v.Optional("current_lag", current_lag, "lag of the current loop beyond the stated one");
    v.Optional("pitch_error", pitch_error, "error of the screw's lead along the stroke");
    v.Optional("lead_wobble", lead_wobble,
               "error of the screw's lead that repeats with every turn; contour circle-test finds it");
  }
};

}  // namespace contour
