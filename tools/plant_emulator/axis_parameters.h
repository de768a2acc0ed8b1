#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/plant_emulator/emulated_machine.h"
#include "tools/plant_emulator/emulator_config.h"
#include "tools/plant_emulator/maxwell_slip_friction.h"

namespace contour::plant {

/// A sine over the stroke or over the motor angle.
struct Wave {
  double amplitude = 0.0;
  double per_unit = 0.0;  ///< radians of phase per metre of travel or per radian of motor angle
  double phase_rad = 0.0;
};

/// A mass on a spring on the table.
struct SideMode {
  double mass_kg = 0.0;
  double stiffness_N_m = 0.0;
  double damping_Ns_m = 0.0;
};

/// One emulated axis in SI, the seed's variation already in it. Table units unless the name says otherwise.
struct AxisParameters {
  double radius_m_rad = 0.0;  ///< R
  double motor_inertia_kgm2 = 0.0;
  double table_mass_kg = 0.0;
  double stiffness_N_m = 0.0;
  double damping_Ns_m = 0.0;
  std::vector<SideMode> side_modes;     ///< their masses are part of the table's
  double counterbalance_mass_kg = 0.0;  ///< beside the table's
  double counterbalance_N = 0.0;
  double counterbalance_N_m = 0.0;
  double half_stroke_m = 0.2;
  double start_position_m = 0.0;
  double start_bristle_N = 0.0;

  EmulatedFrictionLaw law = EmulatedFrictionLaw::kLugre;
  MaxwellSlipParameters friction;  ///< its `base` serves LuGre
  Wave stroke;                     ///< of the friction level
  Wave ripple_plus;
  Wave ripple_minus;
  double friction_temperature_rate_1_K = 0.0;
  double motor_friction_share = 0.0;

  double rated_torque_Nm = 0.0;
  double peak_torque_Nm = 0.0;
  double lag_s = 0.0;
  std::int64_t delay_ns = 0;  ///< beyond the SYNC at which the command is applied
  int delay_cycles = 1;
  std::int64_t answer_delay_ns = 0;
  int answer_delay_every = 1;

  double encoder_counts_per_rev = 0.0;
  double encoder_noise_lsb = 0.0;
  bool incremental_encoder = false;
  bool torque_mode = true;
  bool csp_mode = true;
  double torque_noise_Nm = 0.0;  ///< of the mean over one cycle
  double torque_noise_change = 1.0;
  double torque_noise_change_s = 0.0;
  double scale_counts_per_m = 0.0;  ///< 0: no linear scale

  EmulatedTemperatureConfig temperature;
  EmulatedCascadeConfig cascade;
  EffectsConfig effects;
  std::size_t coupled_axis = 0;  ///< for effects.cross_coupling
};

/// Throws std::invalid_argument naming `axis`. `stream` separates the axes' random numbers.
AxisParameters MakeAxisParameters(const EmulatedAxisConfig& config, const EmulatedAxisPlacement& placement,
                                  std::uint64_t seed, double variation_rel, std::uint64_t stream);

}  // namespace contour::plant
