#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/visit.h"
#include "tools/plant_emulator/outside_effects.h"

// What a real axis does and a textbook model leaves out. Each kind can be switched on in the emulated machine
// by naming it under `effects:`; absent means off. Kinds and parameter names are those that diagnosis
// reports. Torques act on the motor and accelerate towards positive position when positive; friction always
// opposes motion.
namespace contour {

/// Coulomb levels (and break-away levels with them) differ between the directions.
struct AsymmetricCoulombEffect {
  double difference_rel = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("difference_rel", difference_rel, Range{-1.0, 1.0},
               "(Fc_plus - Fc_minus) / mean, added to the base");
  }
};

/// Viscous friction differs between the directions.
struct AsymmetricViscousEffect {
  double difference_rel = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("difference_rel", difference_rel, Range{-1.9, 1.9},
               "(sigma2 upwards - sigma2 downwards) / mean; the mean is the friction section's");
  }
};

/// A torque that is always there: gravity, or an offset of the current sensor.
struct ConstantTorqueEffect {
  double torque_Nm = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("torque_Nm", torque_Nm, kAny, "constant torque on the motor");
  }
};

/// Another Stribeck curve than the friction section states.
struct StribeckEffect {
  double Fs_over_Fc = 1.0;
  double vs_rad_s = 1.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("Fs_over_Fc", Fs_over_Fc, Range{1.0, 5.0}, "break-away over Coulomb level, both directions");
    v.Required("vs_rad_s", vs_rad_s, kPositive, "Stribeck velocity at the motor");
  }
};

/// Friction that varies over the stroke beyond the friction section's own variation.
struct PositionFrictionEffect {
  double amplitude_rel = 0.0;
  double periods_per_stroke = 1.0;
  double phase_rad = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("amplitude_rel", amplitude_rel, Range{-0.9, 0.9}, "peak variation, of the friction level");
    v.Optional("periods_per_stroke", periods_per_stroke, kPositive, "periods of the sine over the stroke");
    v.Optional("phase_rad", phase_rad, kAny, "phase of the sine at mid-stroke");
  }
};

/// The same by a table; straight lines between its points.
struct FrictionMapEffect {
  std::vector<double> position_mm;
  std::vector<double> friction_rel;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("position_mm", position_mm, "positions of the table, ascending");
    v.Required("friction_rel", friction_rel, Range{-0.95, 10.0},
               "friction beyond the friction section's there");
  }
};

/// A hose or cable that pulls back towards mid-stroke.
struct CableSpringEffect {
  double torque_at_stroke_end_Nm = 0.0;
  double hardening_rel = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("torque_at_stroke_end_Nm", torque_at_stroke_end_Nm, kAny,
               "restoring torque at the stroke's end");
    v.Optional("hardening_rel", hardening_rel, Range{0.0, 1.0},
               "share of it that grows with the cube of position");
  }
};

struct RippleTerm {
  double amplitude_rel = 0.0;
  double order_per_rev = 1.0;
  double phase_rad = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("amplitude_rel", amplitude_rel, Range{-0.9, 0.9}, "peak variation, of the friction level");
    v.Required("order_per_rev", order_per_rev, kPositive, "periods per motor turn");
    v.Optional("phase_rad", phase_rad, kAny, "phase at motor angle zero");
  }
};

/// Friction level that varies with the motor angle, an integer (friction_ripple) or any (ball_ripple) number
/// of times per turn.
struct RippleEffect : RippleTerm {
  std::vector<RippleTerm> further;
  template <class Visitor>
  void Visit(Visitor& v) {
    RippleTerm::Visit(v);
    v.Optional("further", further, "of other orders beside it");
  }
};

struct CoggingTerm {
  double amplitude_Nm = 0.0;
  double order_per_rev = 12.0;
  double phase_rad = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("amplitude_Nm", amplitude_Nm, kAny, "peak torque");
    v.Required("order_per_rev", order_per_rev, kPositive, "periods per motor turn");
    v.Optional("phase_rad", phase_rad, kAny, "phase at motor angle zero");
  }
};

/// Detent torque of the motor.
struct CoggingEffect : CoggingTerm {
  std::vector<CoggingTerm> further;
  template <class Visitor>
  void Visit(Visitor& v) {
    CoggingTerm::Visit(v);
    v.Optional("further", further, "of other orders beside it");
  }
};

/// Torque constant that varies with the motor angle.
struct TorqueRippleEffect {
  double amplitude_rel = 0.0;
  double order_per_rev = 6.0;
  double phase_rad = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("amplitude_rel", amplitude_rel, Range{-0.9, 0.9}, "peak variation, of the motor's torque");
    v.Required("order_per_rev", order_per_rev, kPositive, "periods per motor turn");
    v.Optional("phase_rad", phase_rad, kAny, "phase at motor angle zero");
  }
};

struct ViscousTerm {
  double torque_at_max_speed_Nm = 0.0;
  double max_speed_rad_s = 300.0;
  double exponent = 2.0;
  double knee_rad_s = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("torque_at_max_speed_Nm", torque_at_max_speed_Nm, kAny,
               "torque beyond the linear term at max_speed");
    v.Required("max_speed_rad_s", max_speed_rad_s, kPositive, "speed the torque is stated for");
    v.Optional("exponent", exponent, Range{1.0, 4.0}, "power of the speed");
    v.Optional("knee_rad_s", knee_rad_s, kNotNegative, "speed from which it hardly grows; 0: the power law");
  }
};

/// Viscous friction that is not proportional to speed; with y = |speed| / max_speed and k = knee / max_speed,
/// torque_at_max_speed y^exponent, or where there is a knee torque_at_max_speed y (1 + k) / (y + k).
struct ViscousNonlinearEffect : ViscousTerm {
  std::vector<ViscousTerm> further;
  template <class Visitor>
  void Visit(Visitor& v) {
    ViscousTerm::Visit(v);
    v.Optional("further", further, "further curves, added to it");
  }
};

/// Viscous friction that changes with the screw's temperature.
struct TemperatureViscosityEffect {
  double rate_1_K = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("rate_1_K", rate_1_K, Range{-0.1, 0.1},
               "relative change of sigma2 per kelvin above the reference");
  }
};

/// Friction level that changes with time, linearly over `over_s` or towards a limit with a time constant.
struct FrictionDriftEffect {
  double change_rel = 0.0;
  double over_s = 60.0;
  double time_constant_s = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("change_rel", change_rel, Range{-0.9, 5.0}, "relative change when the drift is complete");
    v.Optional("over_s", over_s, kPositive, "time a linear drift takes; it stays there afterwards");
    v.Optional("time_constant_s", time_constant_s, kNotNegative,
               "time constant of an exponential drift; 0: linear");
  }
};

/// The motor gives another torque than the drive believes.
struct TorqueConstantEffect {
  double ratio = 1.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("ratio", ratio, Range{0.1, 10.0}, "true over stated torque constant");
  }
};

/// Iron saturation: torque falls short at high current, with the square of the torque.
struct TorqueSaturationEffect {
  double loss_at_rated_rel = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("loss_at_rated_rel", loss_at_rated_rel, Range{0.0, 0.3},
               "share of the torque lost at rated torque");
  }
};

/// A workpiece is put on or taken off while the machine runs.
struct PayloadStepEffect {
  double inertia_change_rel = 0.0;
  double time_s = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("inertia_change_rel", inertia_change_rel, Range{-0.9, 10.0},
               "change of the table's mass, relative to the axis's whole moving mass");
    v.Required("time_s", time_s, kNotNegative, "when, in the machine's time");
  }
};

/// Screw stiffness and damping stated by the mode they make, in place of the axis's own.
struct ComplianceEffect {
  double antiresonance_Hz = 300.0;
  double damping_ratio = 0.03;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("antiresonance_Hz", antiresonance_Hz, Range{5.0, 2000.0}, "sqrt(K / Mt) / (2 pi)");
    v.Required("damping_ratio", damping_ratio, Range{0.0, 1.0}, "of the resonance");
  }
};

/// Play between screw and nut.
struct BacklashEffect {
  double gap_um = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("gap_um", gap_um, kNotNegative, "free travel of the table");
  }
};

/// A second, softer friction element beside the main one.
struct PreslidingHysteresisEffect {
  double share_rel = 0.0;
  double stiffness_ratio = 0.1;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("share_rel", share_rel, Range{0.0, 0.9}, "share of the friction level in the added element");
    v.Required("stiffness_ratio", stiffness_ratio, Range{1e-3, 100.0},
               "its break-away travel's inverse, of the main's");
  }
};

/// The command takes longer to act than the drive states.
struct InputDelayEffect {
  double delay_us = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("delay_us", delay_us, Range{0.0, 20000.0}, "delay added between SYNC and the current loop");
  }
};

/// The current loop is slower than the drive states.
struct CurrentLagEffect {
  double time_constant_us = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("time_constant_us", time_constant_us, Range{0.0, 20000.0},
               "added to the loop's time constant");
  }
};

/// Encoder disc off centre: one sine per turn in the reported angle.
struct EncoderEccentricityEffect {
  double amplitude_rad = 0.0;
  double phase_rad = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("amplitude_rad", amplitude_rad, kAny, "peak error of the angle");
    v.Optional("phase_rad", phase_rad, kAny, "phase at motor angle zero");
  }
};

/// Interpolation error inside each line of the encoder.
struct EncoderSubdivisionEffect {
  double amplitude_rad = 0.0;
  double order_per_rev = 512.0;
  double phase_rad = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("amplitude_rad", amplitude_rad, kAny, "peak error of the angle");
    v.Required("order_per_rev", order_per_rev, kPositive, "periods per motor turn");
    v.Optional("phase_rad", phase_rad, kAny, "phase at motor angle zero");
  }
};

/// The screw's lead is not the same everywhere: the table stands off where motor and screw put it.
struct PitchErrorEffect {
  double amplitude_um = 0.0;
  double periods_per_stroke = 1.0;
  double phase_rad = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("amplitude_um", amplitude_um, kAny, "peak offset of the table");
    v.Optional("periods_per_stroke", periods_per_stroke, kPositive, "periods of the sine over the stroke");
    v.Optional("phase_rad", phase_rad, kAny, "phase of the sine at mid-stroke");
  }
};

/// The same by a table; straight lines between its points.
struct PitchMapEffect {
  std::vector<double> position_mm;
  std::vector<double> error_um;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("position_mm", position_mm, "positions of the table, ascending");
    v.Required("error_um", error_um, "how far it stands off there");
  }
};

/// Acceleration of another axis pushes this one.
struct CrossCouplingEffect {
  std::string axis;
  double torque_per_acceleration_Nms2_m = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("axis", axis, "the axis whose acceleration acts here");
    v.Required("torque_per_acceleration_Nms2_m", torque_per_acceleration_Nms2_m, kAny,
               "torque on this motor per acceleration of the other table");
  }
};

/// Friction that grows with the load the screw carries.
struct LoadFrictionEffect {
  double friction_per_torque_rel = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("friction_per_torque_rel", friction_per_torque_rel, Range{0.0, 0.9},
               "added friction per accelerating force");
  }
};

/// A vibration from outside.
struct PeriodicForceEffect {
  double amplitude_Nm = 0.0;
  double frequency_Hz = 1.0;
  double phase_rad = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("amplitude_Nm", amplitude_Nm, kAny, "peak, as a torque at the motor; acts on the table");
    v.Required("frequency_Hz", frequency_Hz, kPositive, "constant in time");
    v.Optional("phase_rad", phase_rad, kAny, "phase at time zero");
  }
};

/// The encoder is not read exactly at the SYNC.
struct SampleJitterEffect {
  double rms_us = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("rms_us", rms_us, Range{0.0, 500.0}, "standard deviation of the reading's instant");
  }
};

/// A cutting tool pushes on the table for a while.
struct CuttingForceEffect {
  double force_N = 0.0;
  double start_s = 0.0;
  double end_s = 1e9;
  double every_s = 0.0;
  double lag_ms = 0.0;
  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("force_N", force_N, kAny, "force on the table, positive towards positive position");
    v.Optional("start_s", start_s, kNotNegative, "when it begins, in the machine's time");
    v.Optional("end_s", end_s, kNotNegative, "when it ends");
    v.Optional("every_s", every_s, kNotNegative, "it comes again after so long, from start to end; 0: once");
    v.Optional("lag_ms", lag_ms, Range{0.0, 1000.0}, "time constant with which it rises");
  }
};

/// `emulator.axes.<name>.effects`.
struct EffectsConfig {
  std::optional<AsymmetricCoulombEffect> asymmetric_coulomb;
  std::optional<ConstantTorqueEffect> constant_torque;
  std::optional<StribeckEffect> stribeck;
  std::optional<PositionFrictionEffect> position_friction;
  std::optional<FrictionMapEffect> friction_map;
  std::optional<CableSpringEffect> cable_spring;
  std::optional<RippleEffect> friction_ripple;
  std::optional<RippleEffect> ball_ripple;
  std::optional<CoggingEffect> cogging;
  std::optional<TorqueRippleEffect> torque_ripple;
  std::optional<ViscousNonlinearEffect> viscous_nonlinear;
  std::optional<AsymmetricViscousEffect> asymmetric_viscous;
  std::optional<TemperatureViscosityEffect> temperature_viscosity;
  std::optional<FrictionDriftEffect> friction_drift;
  std::optional<TorqueConstantEffect> torque_constant;
  std::optional<TorqueSaturationEffect> torque_saturation;
  std::optional<PayloadStepEffect> payload_step;
  std::optional<ComplianceEffect> compliance;
  std::optional<BacklashEffect> backlash;
  std::optional<PreslidingHysteresisEffect> presliding_hysteresis;
  std::optional<InputDelayEffect> input_delay;
  std::optional<CurrentLagEffect> current_lag;
  std::optional<EncoderEccentricityEffect> encoder_eccentricity;
  std::optional<EncoderSubdivisionEffect> encoder_subdivision;
  std::optional<PitchErrorEffect> pitch_error;
  std::optional<PitchMapEffect> pitch_map;
  std::optional<CrossCouplingEffect> cross_coupling;
  std::optional<LoadFrictionEffect> load_friction;
  std::optional<PeriodicForceEffect> periodic_force;
  std::optional<SampleJitterEffect> sample_jitter;
  std::optional<CuttingForceEffect> cutting_force;
  std::optional<OutsideEffectsConfig> outside;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("asymmetric_coulomb", asymmetric_coulomb,
               "friction levels that differ between the directions");
    v.Optional("constant_torque", constant_torque, "gravity or a sensor offset");
    v.Optional("stribeck", stribeck, "another Stribeck curve");
    v.Optional("position_friction", position_friction, "friction that varies over the stroke");
    v.Optional("friction_map", friction_map, "friction that varies over the stroke, by a table");
    v.Optional("cable_spring", cable_spring, "a pull back towards mid-stroke");
    v.Optional("friction_ripple", friction_ripple, "friction that varies per turn");
    v.Optional("ball_ripple", ball_ripple, "friction that varies with the balls' circulation");
    v.Optional("cogging", cogging, "detent torque");
    v.Optional("torque_ripple", torque_ripple, "torque constant that varies per turn");
    v.Optional("viscous_nonlinear", viscous_nonlinear, "viscous friction beyond the linear term");
    v.Optional("asymmetric_viscous", asymmetric_viscous,
               "viscous friction that differs between the directions");
    v.Optional("temperature_viscosity", temperature_viscosity,
               "viscous friction that changes with temperature");
    v.Optional("friction_drift", friction_drift, "friction that changes with time");
    v.Optional("torque_constant", torque_constant, "torque constant other than stated");
    v.Optional("torque_saturation", torque_saturation, "torque lost at high current");
    v.Optional("payload_step", payload_step, "a change of mass while running");
    v.Optional("compliance", compliance, "screw stiffness stated by its mode");
    v.Optional("backlash", backlash, "play between screw and nut");
    v.Optional("presliding_hysteresis", presliding_hysteresis, "a second friction element");
    v.Optional("input_delay", input_delay, "delay of the command");
    v.Optional("current_lag", current_lag, "slower current loop");
    v.Optional("encoder_eccentricity", encoder_eccentricity, "once-per-turn error of the encoder");
    v.Optional("encoder_subdivision", encoder_subdivision, "interpolation error of the encoder");
    v.Optional("pitch_error", pitch_error, "error of the screw's lead");
    v.Optional("pitch_map", pitch_map, "error of the screw's lead, by a table");
    v.Optional("cross_coupling", cross_coupling, "reaction to another axis's acceleration");
    v.Optional("load_friction", load_friction, "friction that grows with load");
    v.Optional("periodic_force", periodic_force, "vibration from outside");
    v.Optional("sample_jitter", sample_jitter, "encoder read at uncertain instants");
    v.Optional("cutting_force", cutting_force, "a force on the table for a while");
    v.Optional("outside", outside, "effects that diagnosis has no name for");
  }
};

}  // namespace contour
