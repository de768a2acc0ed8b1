#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "estimator/seven_state_filter.h"

namespace contour {
namespace {

/// An axis of `scale` times the mass, the stiffness and the friction of another one.
FilterSetup Scaled(double scale) {
  FilterSetup setup;
  setup.mechanics = {5e-3 / (2.0 * std::numbers::pi), 90.0 * scale, 10.0 * scale, 40e6 * scale,
                     1000.0 * scale};
  Friction& f = setup.friction;
  f.Fs_plus_N = 50.0 * scale;
  f.Fs_minus_N = 45.0 * scale;
  f.Fc_plus_N = 40.0 * scale;
  f.Fc_minus_N = 36.0 * scale;
  f.vs_m_s = f.sigma1_decay_m_s = 2e-3;
  f.sigma0_N_m = 5e6 * scale;
  f.sigma1_Ns_m = 3000.0 * scale;
  f.sigma2_Ns_m = 500.0 * scale;
  setup.measurement_std_m = 3e-9;
  setup.reported_torque = true;
  return setup;
}

// Noises in newtons would make the filter of the heavy one slow, that of the light one restless.
TEST(FrictionScale, AxesThatDifferByAScaleAreEstimatedAlike) {
  constexpr double kScale = 4.0;  // a power of two: the same bits
  SevenStateFilter<SqrtUkf<kSevenStates>> light{Scaled(1.0)}, heavy{Scaled(kScale)};
  const double per_s = 2.0 * std::numbers::pi * 0.8;
  AxisEstimatorInput in;
  in.fresh = in.enabled = true;
  in.at_rest = false;
  double before_N = 0.0;
  for (int k = 0; k < 3000; ++k) {
    const double turn = per_s * 1e-3 * k;
    in.position_m = 0.01 * (1.0 - std::cos(turn));
    in.commanded_velocity_m_s = 0.01 * per_s * std::sin(turn);
    in.commanded_acceleration_m_s2 = 0.01 * per_s * per_s * std::cos(turn);
    // A third more friction than stated, and a force that comes.
    const double now_N = 90.0 * in.commanded_acceleration_m_s2 +
                         52.0 * std::tanh(2e3 * in.commanded_velocity_m_s) + (k > 2000 ? 30.0 : 0.0);
    in.force_N = {now_N, 0.5 * (now_N + before_N), before_N};
    before_N = now_N;
    AxisEstimatorInput heavier = in;
    for (double& force_N : heavier.force_N) force_N *= kScale;
    const AxisEstimate a = light.Update(in), b = heavy.Update(heavier);
    ASSERT_NEAR(b.friction_N, kScale * a.friction_N, 1e-6 * std::abs(b.friction_N)) << k;
    ASSERT_NEAR(b.disturbance_N, kScale * a.disturbance_N, 1e-6 * std::abs(b.friction_N)) << k;
    ASSERT_NEAR(b.g_plus_N, kScale * a.g_plus_N, 1e-6 * b.g_plus_N) << k;
    ASSERT_NEAR(b.friction_std_N, kScale * a.friction_std_N, 1e-6 * b.friction_std_N) << k;
  }
}

}  // namespace
}  // namespace contour
