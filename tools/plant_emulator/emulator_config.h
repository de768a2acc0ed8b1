#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/visit.h"
#include "tools/plant_emulator/effects_config.h"

// The `emulator:` section of a machine file: what the emulated machine really is, as opposed to what `model:`
// believes it to be. Field names are the YAML keys.
namespace contour {

enum class EmulatedFrictionLaw : std::uint8_t { kLugre, kMaxwellSlip };

constexpr std::string_view Name(EmulatedFrictionLaw law) noexcept {
  return law == EmulatedFrictionLaw::kLugre ? "lugre" : "maxwell_slip";
}
constexpr std::string_view Choices(EmulatedFrictionLaw) noexcept { return "lugre or maxwell_slip"; }
constexpr bool FromName(std::string_view name, EmulatedFrictionLaw& law) noexcept {
  if (name == "lugre") {
    law = EmulatedFrictionLaw::kLugre;
    return true;
  }
  if (name == "maxwell_slip") {
    law = EmulatedFrictionLaw::kMaxwellSlip;
    return true;
  }
  return false;
}

/// Friction of the axis in table units: of the table on its guides and nut, and of what turns before the
/// screw.
struct EmulatedFrictionConfig {
  EmulatedFrictionLaw law = EmulatedFrictionLaw::kLugre;
  int stribeck_exponent = 1;
  double Fs_plus_N = 0.0;
  double Fs_minus_N = 0.0;
  double Fc_plus_N = 0.0;
  double Fc_minus_N = 0.0;
  double vs_mm_s = 2.0;
  double sigma0_N_m = 5e6;
  double sigma1_Ns_m = 3000.0;
  double sigma1_decay_mm_s = 2.0;
  double sigma2_Ns_m = 500.0;
  double position_amplitude_rel = 0.2;
  double ripple_amplitude_rel = 0.08;
  double ripple_order_per_rev = 1.0;
  double temperature_rate_1_K = 0.0;
  int elements = 12;
  double breakaway_min_um = 0.5;
  double breakaway_max_um = 20.0;
  double attraction_N_s = 5e4;
  double motor_share_rel = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("law", law, "friction law");
    v.Optional("stribeck_exponent", stribeck_exponent, Range{1, 2}, "p in exp(-(|v|/vs)^p)");
    v.Required("Fs_plus_N", Fs_plus_N, kNotNegative, "break-away level, positive direction");
    v.Required("Fs_minus_N", Fs_minus_N, kNotNegative, "break-away level, negative direction");
    v.Required("Fc_plus_N", Fc_plus_N, kNotNegative, "Coulomb level, positive direction");
    v.Required("Fc_minus_N", Fc_minus_N, kNotNegative, "Coulomb level, negative direction");
    v.Optional("vs_mm_s", vs_mm_s, kPositive, "Stribeck velocity");
    v.Optional("sigma0_N_m", sigma0_N_m, Range{1e3, 1e9},
               "presliding stiffness; Maxwell slip: of all elements stuck");
    v.Optional("sigma1_Ns_m", sigma1_Ns_m, kNotNegative, "presliding damping at rest");
    v.Optional("sigma1_decay_mm_s", sigma1_decay_mm_s, kPositive,
               "velocity over which the presliding damping fades");
    v.Optional("sigma2_Ns_m", sigma2_Ns_m, kNotNegative, "viscous friction");
    v.Optional("position_amplitude_rel", position_amplitude_rel, Range{0.0, 0.9},
               "peak variation over the stroke");
    v.Optional("ripple_amplitude_rel", ripple_amplitude_rel, Range{0.0, 0.9},
               "peak variation per motor turn");
    v.Optional("ripple_order_per_rev", ripple_order_per_rev, kPositive, "periods of it per motor turn");
    v.Optional("temperature_rate_1_K", temperature_rate_1_K, Range{-0.1, 0.1},
               "relative change of the friction levels per kelvin above the reference temperature");
    v.Optional("elements", elements, Range{10, 16}, "Maxwell slip: number of elements");
    v.Optional("breakaway_min_um", breakaway_min_um, kPositive, "Maxwell slip: shortest break-away travel");
    v.Optional("breakaway_max_um", breakaway_max_um, kPositive, "Maxwell slip: longest break-away travel");
    v.Optional("attraction_N_s", attraction_N_s, kPositive,
               "Maxwell slip: how fast the slipping elements follow the Stribeck curve");
    v.Optional("motor_share_rel", motor_share_rel, Range{0.0, 0.95},
               "share of all this friction that acts on the motor, before the screw");
  }
};

/// Gains of the drive's own cascade: position (CSP) and velocity (CSP, quick stop). Table units.
struct EmulatedCascadeConfig {
  double position_gain_1_s = 250.0;
  double velocity_gain_1_s = 500.0;
  double velocity_integral_1_s = 120.0;
  double velocity_feedforward = 1.0;
  double acceleration_feedforward = 1.0;
  double velocity_filter_Hz = 1500.0;
  double notch_Hz = 0.0;
  double notch_width = 0.5;
  double notch_depth = 0.1;
  double dual_loop_Hz = 0.0;
  int rest_window_counts = 0;
  double rest_delay_ms = 200.0;
  double rest_gain_rel = 0.1;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("position_gain_1_s", position_gain_1_s, kNotNegative, "velocity per position error");
    v.Optional("velocity_gain_1_s", velocity_gain_1_s, kNotNegative, "acceleration per velocity error");
    v.Optional("velocity_integral_1_s", velocity_integral_1_s, kNotNegative, "inverse of the integral time");
    v.Optional("velocity_feedforward", velocity_feedforward, Range{0.0, 1.5},
               "of the interpolated target's velocity");
    v.Optional("acceleration_feedforward", acceleration_feedforward, Range{0.0, 1.5},
               "of the interpolated target's acceleration");
    v.Optional("velocity_filter_Hz", velocity_filter_Hz, kPositive, "low-pass on the velocity seen");
    v.Optional("notch_Hz", notch_Hz, Range{0.0, 3000.0}, "notch on the torque command; 0: none");
    v.Optional("notch_width", notch_width, Range{0.01, 2.0}, "damping ratio of the notch's poles");
    v.Optional("notch_depth", notch_depth, Range{0.0, 3.0}, "what the notch leaves in its middle");
    v.Optional("dual_loop_Hz", dual_loop_Hz, Range{0.0, 3000.0},
               "CSP: the position loop is closed on the linear scale below this frequency and on the motor "
               "above it; 0: on the motor");
    v.Optional(
        "rest_window_counts", rest_window_counts, Range{0, 1000},
        "CSP: an axis read within so many counts of a target that stands is at rest, and has the gains "
        "of rest; 0: it has the others always");
    v.Optional("rest_delay_ms", rest_delay_ms, kPositive, "for so long it must have been so");
    v.Optional("rest_gain_rel", rest_gain_rel, Range{0.001, 1.0},
               "the three gains of rest, as a share of the others");
  }
};

/// Temperature of the screw: ambient plus what friction heats.
struct EmulatedTemperatureConfig {
  double start_degC = 20.0;
  double ambient_degC = 20.0;
  double reference_degC = 20.0;
  double rise_K_W = 0.0;
  double time_constant_s = 600.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("start_degC", start_degC, Range{-50, 150}, "temperature at the start");
    v.Optional("ambient_degC", ambient_degC, Range{-50, 150}, "temperature it goes to at rest");
    v.Optional("reference_degC", reference_degC, Range{-50, 150},
               "temperature the friction values are stated for");
    v.Optional("rise_K_W", rise_K_W, kNotNegative, "steady rise per watt of friction; 0: no heating");
    v.Optional("time_constant_s", time_constant_s, kPositive, "time constant of heating and cooling");
  }
};

/// A part of the table's mass that swings on a spring along the axis.
struct EmulatedSideModeConfig {
  double frequency_Hz = 0.0;
  double mass_share_rel = 0.0;
  double damping_ratio = 0.02;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("frequency_Hz", frequency_Hz, Range{5.0, 1000.0}, "of the mass on its spring, the table held");
    v.Required("mass_share_rel", mass_share_rel, Range{0.001, 0.9}, "of table_mass_kg");
    v.Optional("damping_ratio", damping_ratio, Range{0.0, 1.0}, "of the mass on its spring");
  }
};

/// What carries a vertical axis: a counterweight, or a cylinder with gas.
struct EmulatedCounterbalanceConfig {
  double force_N = 0.0;
  double moving_mass_kg = 0.0;
  double rate_N_mm = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("force_N", force_N, kAny,
               "force on the table at mid-stroke, less the weight that it carries; 0: balanced there");
    v.Optional("moving_mass_kg", moving_mass_kg, kNotNegative,
               "counterweight or piston: moves with the table");
    v.Optional("rate_N_mm", rate_N_mm, kNotNegative,
               "by how much the force falls as the table moves up: the gas's spring rate");
  }
};

struct EmulatedAxisConfig {
  double motor_inertia_kgm2 = 0.0;
  double table_mass_kg = 0.0;
  double screw_stiffness_N_um = 0.0;
  double screw_damping_Ns_m = 0.0;
  std::optional<double> lead_mm;
  std::optional<double> rated_torque_Nm;
  std::optional<double> peak_torque_Nm;
  std::optional<double> encoder_counts_per_rev;
  std::optional<double> scale_counts_per_mm;
  double encoder_noise_lsb = 0.3;
  bool incremental_encoder = false;
  bool torque_mode = true;
  bool csp_mode = true;
  double stroke_mm = 400.0;
  double start_position_mm = 0.0;
  double start_variation_mm = 2.5;
  int delay_cycles = 1;
  double answer_delay_us = 0.0;
  int answer_delay_every = 1;
  double lag_ms = 0.2;
  double torque_noise_Nm = 0.0;
  double torque_noise_change = 1.0;
  double torque_noise_change_s = 0.0;
  EmulatedFrictionConfig friction;
  EmulatedCascadeConfig cascade;
  EmulatedTemperatureConfig temperature;
  std::vector<EmulatedSideModeConfig> side_modes;
  std::optional<EmulatedCounterbalanceConfig> counterbalance;
  EffectsConfig effects;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("motor_inertia_kgm2", motor_inertia_kgm2, kPositive, "inertia of motor, coupling and screw");
    v.Required("table_mass_kg", table_mass_kg, kPositive, "moving mass of the table");
    v.Required("screw_stiffness_N_um", screw_stiffness_N_um, kPositive,
               "axial stiffness between motor and table");
    v.Required("screw_damping_Ns_m", screw_damping_Ns_m, kNotNegative,
               "axial damping between motor and table");
    v.Optional("lead_mm", lead_mm, Range{0.1, 200.0}, "travel per motor turn; default: as the model states");
    v.Optional("rated_torque_Nm", rated_torque_Nm, kPositive,
               "of the emulated drive; default: as `drive` states");
    v.Optional("peak_torque_Nm", peak_torque_Nm, kPositive,
               "of the emulated drive; default: as `drive` states");
    v.Optional("encoder_counts_per_rev", encoder_counts_per_rev, Range{100.0, 16777216.0},
               "of the emulated encoder; default: as `drive` states");
    v.Optional("scale_counts_per_mm", scale_counts_per_mm, kPositive,
               "of the emulated linear scale (0x60E4:01); default: as `drive` states, none if it has none");
    v.Optional("incremental_encoder", incremental_encoder,
               "the drive counts from where the axis stands at power-up; NMT reset node is one, too");
    v.Optional("torque_mode", torque_mode, "0x6502 has cst; without, csp alone");
    v.Optional("csp_mode", csp_mode, "0x6502 has csp; without, cst alone");
    v.Optional("encoder_noise_lsb", encoder_noise_lsb, Range{0.0, 1000.0},
               "standard deviation of a reading, counts");
    v.Optional("stroke_mm", stroke_mm, kPositive, "travel over which friction varies");
    v.Optional("start_position_mm", start_position_mm, kAny, "where the axis stands at the start");
    v.Optional("start_variation_mm", start_variation_mm, kNotNegative,
               "the seed moves the start by at most this");
    v.Optional("delay_cycles", delay_cycles, Range{1, 8},
               "SYNCs from a sample to the torque computed from it");
    v.Optional("answer_delay_us", answer_delay_us, Range{0.0, 20000.0},
               "a slow drive: added between SYNC and the answer to it");
    v.Optional("answer_delay_every", answer_delay_every, Range{1, 1000000},
               "only every so many SYNCs the answer is delayed");
    v.Optional("lag_ms", lag_ms, Range{0.0, 20.0}, "time constant of the current loop");
    v.Optional("torque_noise_Nm", torque_noise_Nm, kNotNegative,
               "standard deviation of the noise on the motor's torque, as a mean over one cycle; white");
    v.Optional("torque_noise_change", torque_noise_change, kNotNegative,
               "factor on that noise from torque_noise_change_s on");
    v.Optional("torque_noise_change_s", torque_noise_change_s, kNotNegative, "in the machine's time");
    v.Required("friction", friction, "friction of the axis");
    v.Optional("cascade", cascade, "the drive's own control loops");
    v.Optional("temperature", temperature, "temperature of the screw");
    v.Optional("side_modes", side_modes, "parts of the table that swing on springs");
    v.Optional("counterbalance", counterbalance, "what carries a vertical axis");
    v.Optional("effects", effects, "what a textbook model leaves out");
  }
};

/// The Modbus server that stands for the machine's inputs and outputs. Addresses count from 0.
struct EmulatedIoConfig {
  std::string host = "127.0.0.1";
  int port = 1502;
  int emergency_stop_ok_input = 0;
  int enable_chain_ok_input = 1;
  int screw_temperature_register = 0;
  int lubrication_coil = 0;
  int open_emergency_stop_coil = 100;
  int open_enable_chain_coil = 101;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("host", host, "address the server listens on");
    v.Optional("port", port, Range{1, 65535}, "TCP port");
    v.Optional("emergency_stop_ok_input", emergency_stop_ok_input, Range{0, 199}, "discrete input");
    v.Optional("enable_chain_ok_input", enable_chain_ok_input, Range{0, 199}, "discrete input");
    v.Optional("screw_temperature_register", screw_temperature_register, Range{0, 199},
               "input register, tenths of a degree Celsius, signed");
    v.Optional("lubrication_coil", lubrication_coil, Range{0, 199}, "coil the master sets");
    v.Optional("open_emergency_stop_coil", open_emergency_stop_coil, Range{0, 199},
               "coil: 1 opens the emergency-stop circuit");
    v.Optional("open_enable_chain_coil", open_enable_chain_coil, Range{0, 199},
               "coil: 1 opens the enable chain");
  }
};

/// The whole `emulator:` section.
struct EmulatorConfig {
  std::uint64_t seed = 1;
  double parameter_variation_rel = 0.05;
  double silence_ms = 200.0;
  std::map<std::string, EmulatedAxisConfig> axes;
  std::optional<EmulatedIoConfig> io;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("seed", seed, kNotNegative, "varies noise, ripple phases, start and parameters");
    v.Optional("parameter_variation_rel", parameter_variation_rel, Range{0.0, 0.5},
               "the seed varies every parameter by at most this");
    v.Optional(
        "silence_ms", silence_ms, Range{1.0, 600000.0},
        "stepped by SYNC, with a drive enabled: after so long without a frame time runs by the clock, so "
        "that the drives notice");
    v.Required("axes", axes, "the emulated axes, by the names under `axes`");
    v.Optional("io", io, "Modbus server for the emulated inputs and outputs");
  }
};

}  // namespace contour
