#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/side_mode.h"
#include "core/visit.h"
#include "estimator/extension_config.h"
#include "estimator/friction_config.h"

// A model that stands alone, for axes that have no machine file. Optional keys that are left out are not
// known: docs/diagnosis_files.md says what is assumed then.
namespace contour::diagnosis {

/// `friction:` of such a model: the keys of a machine file, and fewer of them if need be. Table values in N,
/// or motor values in Nm.
struct LooseFrictionConfig {
  FrictionSide acts_on = FrictionSide::kTable;
  std::optional<double> stribeck_exponent;
  /// Coulomb levels and viscous friction that are left out come from the log (CompleteFromLog).
  std::optional<double> Fc_plus, Fc_minus, Fs_plus, Fs_minus, vs, sigma0, sigma1, sigma1_decay, sigma2;
  double motor_share_rel = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("acts_on", acts_on, kAny, "whether the values below are at the table (N) or the motor (Nm)");
    v.Optional("stribeck_exponent", stribeck_exponent, Range{0.5, 4.0},
               "n of exp(-(|v| / vs)^n); left out: 1, or with no curve stated 1 or 2, as the log has it");
    v.Optional("motor_share_rel", motor_share_rel, Range{0.0, 0.9},
               "share of the friction at the table that acts on the motor, before the screw");
    const bool table = acts_on == FrictionSide::kTable;
    v.Optional(table ? "Fc_plus_N" : "Fc_plus_Nm", Fc_plus, kNotNegative,
               "Coulomb friction, positive direction; from the log when left out");
    v.Optional(table ? "Fc_minus_N" : "Fc_minus_Nm", Fc_minus, kNotNegative,
               "Coulomb friction, negative direction; that of Fc_plus when left out");
    v.Optional(table ? "Fs_plus_N" : "Fs_plus_Nm", Fs_plus, kNotNegative,
               "break-away friction, positive direction; that of Fc_plus when left out");
    v.Optional(table ? "Fs_minus_N" : "Fs_minus_Nm", Fs_minus, kNotNegative,
               "break-away friction, negative direction; that of Fc_minus when left out");
    v.Optional(table ? "vs_mm_s" : "vs_rad_s", vs, kPositive, "Stribeck velocity");
    v.Optional(table ? "sigma0_N_m" : "sigma0_Nm_rad", sigma0, kPositive, "bristle stiffness");
    v.Optional(table ? "sigma1_Ns_m" : "sigma1_Nms_rad", sigma1, kNotNegative, "bristle damping");
    v.Optional(table ? "sigma1_decay_mm_s" : "sigma1_decay_rad_s", sigma1_decay, kNotNegative,
               "velocity at which bristle damping fades; 0: it does not");
    v.Optional(table ? "sigma2_Ns_m" : "sigma2_Nms_rad", sigma2, kNotNegative,
               "viscous friction; from the log when left out");
  }
};

/// `model:`, or the whole file.
struct LooseModelConfig {
  // Rotary: seen at the motor.
  std::optional<double> lead_mm;
  std::optional<double> motor_inertia_kgm2;
  double table_mass_kg = 0.0;
  std::optional<double> load_inertia_kgm2;
  std::optional<double> screw_stiffness_N_um;
  std::optional<double> stiffness_Nm_rad;
  double screw_damping_Ns_m = 0.0;
  double damping_Nms_rad = 0.0;
  double constant_torque_Nm = 0.0;
  double gear_ratio = 1.0;
  // Linear: seen at the carriage.
  std::optional<double> mass_kg;
  std::optional<double> load_mass_kg;
  double constant_force_N = 0.0;

  LooseFrictionConfig friction;
  std::vector<SideMode> side_modes;  ///< read, as identify writes them, and not used here
  std::map<std::string, double> uncertainty;
  ExtensionsConfig extensions;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("lead_mm", lead_mm, Range{0.1, 200.0}, "travel of the table per motor turn");
    v.Optional(
        "motor_inertia_kgm2", motor_inertia_kgm2, kPositive,
        "rotary axes: inertia of motor, coupling and screw; everything that turns, when there is no table");
    v.Optional("table_mass_kg", table_mass_kg, kNotNegative,
               "rotary axes: moving mass of the table; needs lead_mm");
    v.Optional("load_inertia_kgm2", load_inertia_kgm2, kPositive,
               "rotary axes: inertia of the load seen at the motor, in place of table_mass_kg");
    v.Optional("screw_stiffness_N_um", screw_stiffness_N_um, kPositive,
               "axial stiffness between drive and load; none: the axis is rigid");
    v.Optional("stiffness_Nm_rad", stiffness_Nm_rad, kPositive, "the same, seen at the motor");
    v.Optional("screw_damping_Ns_m", screw_damping_Ns_m, kNotNegative,
               "axial damping between drive and load");
    v.Optional("damping_Nms_rad", damping_Nms_rad, kNotNegative, "the same, seen at the motor");
    v.Optional("constant_torque_Nm", constant_torque_Nm, kAny,
               "rotary axes: torque that always acts, positive towards positive position");
    v.Optional("gear_ratio", gear_ratio, Range{1e-3, 1e4},
               "rotary axes: turns of the motor per turn of the axis, where the log has the axis's angle and "
               "torque; orders per turn are the motor's");
    v.Optional("mass_kg", mass_kg, kPositive, "linear axes: the mass that the force moves");
    v.Optional("load_mass_kg", load_mass_kg, kPositive,
               "linear axes: a second mass behind screw_stiffness_N_um");
    v.Optional("constant_force_N", constant_force_N, kAny,
               "linear axes: force that always acts, positive towards positive position");
    v.Optional("friction", friction, "LuGre friction of the axis; from the log when left out");
    v.Optional("side_modes", side_modes, "parts of the table that swing; for the controller, not used here");
    v.Optional("uncertainty", uncertainty, Range{0.0, 10.0},
               "relative standard deviation of a parameter, by its key");
    v.Optional("extensions", extensions, "further effects with their parameters, as diagnosis writes them");
  }
};

/// `drive:` of such a file.
struct LooseDriveConfig {
  double delay_ms = 0.0;
  double lag_ms = 0.0;
  double encoder_counts_per_rev = 0.0;
  double position_step_um = 0.0;
  double torque_step_Nm = 0.0;
  double force_step_N = 0.0;
  double rated_torque_Nm = 0.0;
  double rated_force_N = 0.0;
  double torque_constant_Nm_A = 0.0;
  double force_constant_N_A = 0.0;
  std::optional<std::array<double, 2>> stroke_mm;
  std::optional<bool> endless;  ///< nothing: as the log looks

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("delay_ms", delay_ms, Range{0.0, 100.0},
               "from a row's position to the beginning of its command");
    v.Optional("lag_ms", lag_ms, Range{0.0, 20.0}, "time constant of the drive's current loop");
    v.Optional("encoder_counts_per_rev", encoder_counts_per_rev, kNotNegative, "rotary axes; 0: unknown");
    v.Optional("position_step_um", position_step_um, kNotNegative, "linear axes: one count; 0: unknown");
    v.Optional("torque_step_Nm", torque_step_Nm, kNotNegative,
               "smallest step of the torque command; 0: unknown");
    v.Optional("force_step_N", force_step_N, kNotNegative, "linear axes: the same");
    v.Optional("rated_torque_Nm", rated_torque_Nm, kNotNegative, "rated torque of the motor; 0: unknown");
    v.Optional("rated_force_N", rated_force_N, kNotNegative, "linear axes: the same");
    v.Optional("torque_constant_Nm_A", torque_constant_Nm_A, kNotNegative,
               "of a log with current_A; 0: from the log, as the stated inertia asks for");
    v.Optional("force_constant_N_A", force_constant_N_A, kNotNegative, "linear axes: the same");
    v.Optional("endless", endless, kAny,
               "rotary axes that turn for ever: no cause is looked for that goes with a stroke");
    v.Optional("stroke_mm", stroke_mm, kAny, "ends of the table's travel; those of the log when left out");
  }
};

/// The whole file.
struct LooseAxisFile {
  LooseModelConfig model;
  LooseDriveConfig drive;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("model", model, "what is believed of the axis");
    v.Optional("drive", drive, "what is known of drive and encoder");
  }
};

}  // namespace contour::diagnosis
