#pragma once

#include "tools/plant_emulator/portable_math.h"

namespace contour::plant {

/// Friction levels of one direction, N.
struct FrictionLevels {
  double Fs_N = 0.0;
  double Fc_N = 0.0;
};

/// What both friction laws share: the steady curve and the damping beside it. SI, table side.
struct FrictionParameters {
  FrictionLevels plus;
  FrictionLevels minus;
  double vs_m_s = 2e-3;
  int stribeck_exponent = 1;  ///< 1 or 2
  double sigma0_N_m = 5e6;
  double sigma1_Ns_m = 3000.0;
  double sigma1_decay_m_s = 2e-3;
  double sigma2_Ns_m = 500.0;
};

/// Factors on the friction levels, for each direction, and on the viscous term: stroke, turn, temperature,
/// time.
struct FrictionScale {
  double plus = 1.0;
  double minus = 1.0;
  double viscous = 1.0;
};

/// Friction force over one step, as a line in the step's mean velocity: constant + slope v.
struct FrictionLine {
  double constant_N = 0.0;
  double slope_Ns_m = 0.0;
};

/// Smallest friction level used: LuGre divides by it (erratum to eq. 9: g bounded away from 0).
inline constexpr double kSmallestLevel_N = 1e-6;

/// g(v) > 0 in both directions: Fc + (Fs - Fc) exp(-(|v|/vs)^p), levels of the direction of v, scaled.
inline double SteadyLevel_N(const FrictionParameters& p, const FrictionScale& scale,
                            double velocity_m_s) noexcept {
  const FrictionLevels& level = velocity_m_s < 0.0 ? p.minus : p.plus;
  const double factor = velocity_m_s < 0.0 ? scale.minus : scale.plus;
  double x = (velocity_m_s < 0.0 ? -velocity_m_s : velocity_m_s) / p.vs_m_s;
  if (p.stribeck_exponent == 2) x *= x;
  const double g = factor * (level.Fc_N + (level.Fs_N - level.Fc_N) * portable::Exp(-x));
  return g > kSmallestLevel_N ? g : kSmallestLevel_N;
}

/// sigma1 exp(-(v/vd)^2): presliding damping that fades with speed, which keeps LuGre passive.
inline double PreslidingDamping_Ns_m(const FrictionParameters& p, double velocity_m_s) noexcept {
  const double x = velocity_m_s / p.sigma1_decay_m_s;
  return p.sigma1_Ns_m * portable::Exp(-x * x);
}

}  // namespace contour::plant
