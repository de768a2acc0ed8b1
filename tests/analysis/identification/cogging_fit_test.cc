#include "analysis/identification/cogging_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::MotorWave;

constexpr int kHalf = 4;

std::array<MotorWave, identify::kMostWaves> FoundOn(const plant::AxisParameters& truth) {
  const std::vector<double> speeds = {0.5e-3, 1e-3, 2e-3, 5e-3, 10e-3};
  const GeneratedAxis axis{truth};
  const identify::Measured record =
      axis.Drive(StrokesDuration_s(5e-3, speeds), Strokes(5e-3, speeds), [](double) { return 0.0; });
  const identify::TableAxis model = Exactly(truth);
  const auto instants = identify::Kinematics(record, model.delay_s, model.lag_s, kHalf, 4);
  const auto sliding = identify::FitSliding(instants, 1.0, model.radius_m_rad);
  return identify::FindCogging(instants, model, sliding, (2 * kHalf + 1) * record.period_s);
}

TEST(FindCogging, FindsOrdersAmplitudesAndPhases) {
  plant::AxisParameters truth = PlainAxis();
  truth.effects.cogging = CoggingEffect{};
  truth.effects.cogging->amplitude_Nm = 3e-3;
  truth.effects.cogging->order_per_rev = 12;
  truth.effects.cogging->phase_rad = 0.7;
  truth.effects.cogging->further = {{1.5e-3, 18, -1.0}};
  const auto found = FoundOn(truth);
  const double R = truth.radius_m_rad;
  ASSERT_EQ(found[0].order, 12);
  EXPECT_NEAR(found[0].cosine_N * R, 3e-3 * std::sin(0.7), 0.2e-3);
  EXPECT_NEAR(found[0].sine_N * R, 3e-3 * std::cos(0.7), 0.2e-3);
  ASSERT_EQ(found[1].order, 18);
  EXPECT_NEAR(std::hypot(found[1].cosine_N, found[1].sine_N) * R, 1.5e-3, 0.15e-3);
  EXPECT_EQ(found[2].order, 0);
}

TEST(FindCogging, TakesNoFrictionForCogging) {
  plant::AxisParameters truth = PlainAxis();
  truth.ripple_plus = {0.08, 1.0, 0.4};
  truth.ripple_minus = {0.08, 1.0, 2.0};
  truth.stroke = {0.2, 15.0, 1.0};
  EXPECT_EQ(FoundOn(truth)[0].order, 0);
}

}  // namespace
}  // namespace contour::test
