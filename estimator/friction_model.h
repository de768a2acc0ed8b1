#pragma once

#include <algorithm>
#include <cmath>

#include "estimator/exponential.h"
#include "estimator/friction_config.h"

/// The LuGre law (paper eqs. 5-8, corrected) as pure functions at the table: N, m, s. The bristle is carried
/// as the force F = sigma0 z it exerts. Errata are listed in docs/estimator.md.
namespace contour {

/// Friction levels never reach zero: eq. 9 divides by g.
inline constexpr double kLeastLevel_N = 1e-3;

/// (|v| / vs)^n.
inline double StribeckPower(double speed_m_s, double vs_m_s, double exponent) noexcept {
  const double u = speed_m_s / vs_m_s;
  return exponent == 1.0 ? u : std::pow(u, exponent);
}

/// exp(-(|v| / vs)^n).
inline double StribeckDecay(double speed_m_s, double vs_m_s, double exponent) noexcept {
  return ExpOfNegative(-StribeckPower(speed_m_s, vs_m_s, exponent));
}

/// Stribeck factor of the level: g(v) / Fc = 1 + (Fs / Fc - 1) exp(-(|v| / vs)^n).
inline double StribeckFactor(double breakaway_ratio, double speed_m_s, double vs_m_s,
                             double exponent) noexcept {
  return 1.0 + (breakaway_ratio - 1.0) * StribeckDecay(speed_m_s, vs_m_s, exponent);
}

/// g(v) of eq. 7, positive in both directions (the printed sgn() makes the bristle grow without bound for v <
/// 0).
inline double FrictionLevel(const Friction& f, double velocity_m_s) noexcept {
  const bool forward = velocity_m_s >= 0.0;
  const double coulomb = forward ? f.Fc_plus_N : f.Fc_minus_N;
  const double breakaway = forward ? f.Fs_plus_N : f.Fs_minus_N;
  const double g =
      coulomb * StribeckFactor(breakaway / coulomb, std::abs(velocity_m_s), f.vs_m_s, f.stribeck_exponent);
  return std::max(g, kLeastLevel_N);
}

/// Fraction of the way from F to sgn(v) g that the bristle goes in `duration_s` at constant velocity:
/// 1 - exp(-a t), a = sigma0 |v| / g. Goes to a t for small a t; nothing is divided by v (eq. 9's f21 is 0/0
/// at v = 0).
inline double BristleRelaxation(double sigma0_N_m, double speed_m_s, double level_N,
                                double duration_s) noexcept {
  return -Expm1(-sigma0_N_m * speed_m_s / level_N * duration_s);
}

/// Eq. 6 over a time at constant velocity, exact: F' = sigma0 v - sigma0 |v| F / g.
inline double BristleAfter(double bristle_N, double velocity_m_s, double sigma0_N_m, double level_N,
                           double duration_s) noexcept {
  const double target = std::copysign(level_N, velocity_m_s);
  return bristle_N +
         (target - bristle_N) * BristleRelaxation(sigma0_N_m, std::abs(velocity_m_s), level_N, duration_s);
}

/// A bristle may exceed its level: after a reversal between unequal levels, and with the lag of a falling
/// Stribeck curve. By more than this many levels it does so only because the estimated level has just fallen.
inline constexpr double kMostLevels = 2.0;

/// F / g of a bristle within what it can be.
inline double ShareOfLevel(double bristle_N, double level_N) noexcept {
  return std::clamp(bristle_N / level_N, -kMostLevels, kMostLevels);
}

/// sigma1 z' of eq. 5 with a damping that fades with speed: sigma1(v) = sigma1 exp(-(v / vd)^2). With F =
/// sigma0 z, z' = v - |v| F / g.
inline double BristleDamping(const Friction& f, double bristle_N, double velocity_m_s,
                             double level_N) noexcept {
  const double u = velocity_m_s / f.sigma1_decay_m_s;
  const double rate = velocity_m_s - std::abs(velocity_m_s) * ShareOfLevel(bristle_N, level_N);
  return f.sigma1_Ns_m * Exp(-u * u) * rate;
}

/// One rigid mass with LuGre friction, stepped: the torque balance of eq. 3 and the law above.
struct FrictionState {
  double position_m = 0.0;
  double velocity_m_s = 0.0;
  double bristle_N = 0.0;
};

/// Total friction (bristle, bristle damping, viscous), positive opposing positive motion.
inline double TotalFriction(const Friction& f, const FrictionState& s) noexcept {
  const double g = FrictionLevel(f, s.velocity_m_s);
  return s.bristle_N + BristleDamping(f, s.bristle_N, s.velocity_m_s, g) + f.sigma2_Ns_m * s.velocity_m_s;
}

/// One step under a constant force. The new bristle force goes into the velocity update: stepping both with
/// each other's old value, as eq. 9 does, is unstable in presliding. Damping is taken at the step's start but
/// treated implicitly.
inline FrictionState StepRigid(const Friction& f, const FrictionState& s, double mass_kg, double force_N,
                               double duration_s) noexcept {
  FrictionState out;
  const double g = FrictionLevel(f, s.velocity_m_s);
  out.bristle_N = BristleAfter(s.bristle_N, s.velocity_m_s, f.sigma0_N_m, g, duration_s);
  const double u = s.velocity_m_s / f.sigma1_decay_m_s;
  const double sigma1 = f.sigma1_Ns_m * Exp(-u * u);
  // sigma1 z' = sigma1 v (1 - sgn(v) F / g): its factor of v joins the viscous damping.
  const double damping =
      f.sigma2_Ns_m + sigma1 * (1.0 - (s.velocity_m_s < 0.0 ? -out.bristle_N : out.bristle_N) / g);
  out.velocity_m_s = (s.velocity_m_s + (force_N - out.bristle_N) * duration_s / mass_kg) /
                     (1.0 + std::max(damping, 0.0) * duration_s / mass_kg);
  out.position_m = s.position_m + 0.5 * duration_s * (s.velocity_m_s + out.velocity_m_s);
  return out;
}

}  // namespace contour
