#include "estimator/angle_force_tuning.h"

#include <gtest/gtest.h>

#include <numbers>

namespace contour {
namespace {

FilterSetup Example() {
  FilterSetup s;
  s.mechanics.radius_m_rad = 10e-3 / (2.0 * std::numbers::pi);
  s.mechanics.mass_kg = 100.0;
  s.friction.Fc_plus_N = 90.0;
  s.friction.Fc_minus_N = 70.0;
  s.friction.vs_m_s = 3e-3;
  s.measurement_std_m = 2e-9;
  s.period_s = 0.5e-3;
  return s;
}

TEST(AngleForceTuning, IsOfTheAxis) {
  const AngleForceMap::Tuning t = AngleForceTuning(Example());
  EXPECT_NEAR(t.lead_m, 10e-3, 1e-12);
  EXPECT_DOUBLE_EQ(t.level_N, 80.0);
  EXPECT_DOUBLE_EQ(t.vs_m_s, 3e-3);
  EXPECT_DOUBLE_EQ(t.mass_kg, 100.0);
  EXPECT_DOUBLE_EQ(t.period_s, 0.5e-3);
  EXPECT_NEAR(t.noise_N, 2.449 * 2e-9 * 100.0 / 0.25e-6, 1e-3);
  EXPECT_DOUBLE_EQ(t.rate, Example().config.cogging_rate);
}

TEST(AngleForceTuning, NothingIsLearntWhereNothingMayBe) {
  FilterSetup fixed = Example();
  fixed.config.adapt = false;
  EXPECT_EQ(AngleForceTuning(fixed).rate, 0.0);
  FilterSetup smooth = Example();
  smooth.friction.Fc_plus_N = smooth.friction.Fc_minus_N = 0.0;
  EXPECT_EQ(AngleForceTuning(smooth).rate, 0.0);
}

}  // namespace
}  // namespace contour
