#pragma once

#include <cmath>

#include "core/mechanics.h"

namespace contour::test {

/// A plain plant to close loops on: two masses and a spring (or one mass, when rigid), a first-order drive
/// lag, and LuGre friction on the table. Forces and positions as seen at the table. Integrated by fine fixed
/// steps.
struct ScrewAxis {
  Mechanics mechanics;
  double lag_s = 2e-4;
  double gain = 1.0;  ///< force per commanded force
  bool rigid = false;
  // Friction, off while coulomb_N is 0: g = coulomb + (stiction - coulomb) exp(-|v| / stribeck).
  double coulomb_N = 0.0;
  double stiction_N = 0.0;
  double stribeck_m_s = 2e-3;
  double bristle_N_m = 5e6;
  double viscous_Ns_m = 0.0;

  double motor_m = 0.0, motor_m_s = 0.0;
  double table_m = 0.0, table_m_s = 0.0;
  double force_N = 0.0;
  double bristle_m = 0.0;

  [[nodiscard]] double BristleForce() const { return bristle_N_m * bristle_m; }

  void Step(double command_N, double period_s) {
    constexpr int kSubsteps = 200;
    const double h = period_s / kSubsteps;
    const double motor_kg = mechanics.mass_kg - mechanics.table_mass_kg;
    for (int i = 0; i < kSubsteps; ++i) {
      const double wanted = gain * command_N;
      // Mean of the lagged force over the substep, exactly.
      const double decay = lag_s > 0.0 ? std::exp(-h / lag_s) : 0.0;
      const double mean = wanted + (force_N - wanted) * (lag_s > 0.0 ? lag_s / h * (1.0 - decay) : 0.0);
      force_N = wanted + (force_N - wanted) * decay;
      const double friction = StepBristle(rigid ? motor_m_s : table_m_s, h);
      if (rigid) {
        // Exact for a force that does not change: no error of the integrator itself.
        const double a = (mean - friction) / mechanics.mass_kg;
        const double rate = viscous_Ns_m / mechanics.mass_kg;
        const double kept = std::exp(-rate * h);
        const double gained = rate > 0.0 ? (1.0 - kept) / rate : h;
        const double before = motor_m_s;
        motor_m_s = kept * before + gained * a;
        motor_m += 0.5 * h * (before + motor_m_s);
        table_m = motor_m;
        table_m_s = motor_m_s;
      } else {
        const double spring =
            mechanics.stiffness_N_m * (motor_m - table_m) + mechanics.damping_Ns_m * (motor_m_s - table_m_s);
        motor_m_s += h * (mean - spring) / motor_kg;
        table_m_s += h * (spring - friction - viscous_Ns_m * table_m_s) / mechanics.table_mass_kg;
        motor_m += h * motor_m_s;
        table_m += h * table_m_s;
      }
    }
  }

 private:
  double StepBristle(double velocity_m_s, double h) {
    if (coulomb_N <= 0.0) return 0.0;
    const double g = coulomb_N + (stiction_N - coulomb_N) * std::exp(-std::abs(velocity_m_s) / stribeck_m_s);
    const double rate = bristle_N_m * std::abs(velocity_m_s) / g;
    const double gained = rate * h > 1e-9 ? -std::expm1(-rate * h) / rate : h;
    bristle_m += gained * (velocity_m_s - rate * bristle_m);
    return BristleForce();
  }
};

}  // namespace contour::test
