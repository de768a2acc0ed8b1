#pragma once

#include "core/mechanics.h"

namespace contour {

/// One axis as its loop sees it: motor and table joined by the screw, all seen at the table (R theta, T / R),
/// and what lies between a computed torque and the motor.
struct TwoInertiaAxis {
  double motor_mass_kg = 0.0;  ///< M1 = Jm / R^2
  double table_mass_kg = 0.0;  ///< M2
  double stiffness_N_m = 0.0;  ///< K
  double damping_Ns_m = 0.0;   ///< C, of the screw
  double viscous_Ns_m = 0.0;   ///< sigma2, of the table
  double lag_s = 0.0;          ///< of the drive's current loop
  int delay_cycles = 1;        ///< from a sample to the torque computed from it
  double dead_time_s = 0.0;    ///< further delay, any

  friend bool operator==(const TwoInertiaAxis&, const TwoInertiaAxis&) = default;
};

constexpr TwoInertiaAxis ToTwoInertiaAxis(const Mechanics& m, double viscous_Ns_m, double lag_s,
                                          int delay_cycles) noexcept {
  return {m.mass_kg - m.table_mass_kg,
          m.table_mass_kg,
          m.stiffness_N_m,
          m.damping_Ns_m,
          viscous_Ns_m,
          lag_s,
          delay_cycles,
          0.0};
}

}  // namespace contour
