#include "estimator/angle_force_tuning.h"

#include <cmath>
#include <numbers>

namespace contour {

AngleForceMap::Tuning AngleForceTuning(const FilterSetup& s) {
  AngleForceMap::Tuning t;
  t.lead_m = 2.0 * std::numbers::pi * s.mechanics.radius_m_rad;
  // A second difference of the position takes sqrt(1 + 4 + 1) of its noise.
  t.noise_N = std::sqrt(6.0) * s.measurement_std_m * s.mechanics.mass_kg / (s.period_s * s.period_s);
  const double level_N = 0.5 * (s.friction.Fc_plus_N + s.friction.Fc_minus_N);
  // Without friction there is nothing to tell a motor's force by.
  t.rate = s.config.adapt && level_N > 0.0 ? s.config.cogging_rate : 0.0;
  t.period_s = s.period_s;
  t.level_N = level_N;
  t.vs_m_s = s.friction.vs_m_s;
  t.mass_kg = s.mechanics.mass_kg;
  return t;
}

}  // namespace contour
