#pragma once

#include <cmath>

#include "tools/plant_emulator/friction_parameters.h"

namespace contour::plant {

/// The LuGre law (Canudas de Wit, Olsson, Astrom, Lischinsky, IEEE TAC 40(3), 1995):
///   z' = v - sigma0 |v| z / g(v),   F = sigma0 z + sigma1(v) z' + sigma2 v,
/// with g > 0 in both directions and sigma1 fading with speed.
///
/// A step is taken in two halves: Line() says what force the step will see as a line in its mean velocity,
/// the plant solves for that velocity implicitly, Commit() moves the bristle with it. For a given mean speed
/// the bristle is integrated exactly (exponential form), so sigma0 |v| h / g may be anything.
class LugreFriction {
 public:
  explicit LugreFriction(const FrictionParameters& parameters) noexcept : p_(parameters) {}

  /// `expected_m_s`: the step's mean velocity as far as known; sets direction, level and decay rate.
  FrictionLine Line(double expected_m_s, double step_s, const FrictionScale& scale) noexcept {
    const double speed = std::fabs(expected_m_s);
    const double g = SteadyLevel_N(p_, scale, expected_m_s);
    decay_ = portable::DecayOver(p_.sigma0_N_m * speed * step_s / g);
    step_s_ = step_s;
    const double sigma1 = PreslidingDamping_Ns_m(p_, expected_m_s);
    // z1 = z e + v h phi; mean of sigma0 z by the trapezoid, mean of z' exactly (z1 - z) / h.
    const double constant = p_.sigma0_N_m * z_m_ * 0.5 * (1.0 + decay_.remaining) +
                            sigma1 * z_m_ * (decay_.remaining - 1.0) / step_s;
    const double slope = p_.sigma0_N_m * 0.5 * step_s * decay_.mean + sigma1 * decay_.mean;
    return {constant, slope + p_.sigma2_Ns_m * scale.viscous};
  }

  /// Moves the bristle over the step that Line() prepared.
  void Commit(double velocity_m_s) noexcept {
    z_m_ = portable::WithoutDust(z_m_ * decay_.remaining + velocity_m_s * step_s_ * decay_.mean);
  }

  /// Whole force now; positive opposes positive motion.
  [[nodiscard]] double Force_N(double velocity_m_s, const FrictionScale& scale) const noexcept {
    const double g = SteadyLevel_N(p_, scale, velocity_m_s);
    const double rate = velocity_m_s - p_.sigma0_N_m * std::fabs(velocity_m_s) * z_m_ / g;
    return p_.sigma0_N_m * z_m_ + PreslidingDamping_Ns_m(p_, velocity_m_s) * rate +
           p_.sigma2_Ns_m * scale.viscous * velocity_m_s;
  }

  [[nodiscard]] double Elastic_N() const noexcept { return p_.sigma0_N_m * z_m_; }
  [[nodiscard]] double bristle_m() const noexcept { return z_m_; }
  void SetElastic_N(double force_N) noexcept { z_m_ = force_N / p_.sigma0_N_m; }

 private:
  FrictionParameters p_;
  double z_m_ = 0.0;
  double step_s_ = 0.0;
  portable::Decay decay_;
};

}  // namespace contour::plant
