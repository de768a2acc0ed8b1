#include "analysis/diagnosis/causes/waves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

TEST(Waves, AnOrderIsWholeToRounding) {
  EXPECT_TRUE(IsWholeOrder(12.0));
  EXPECT_TRUE(IsWholeOrder(0.1 + 0.7 + 0.2));
  EXPECT_FALSE(IsWholeOrder(12.01));
  EXPECT_TRUE(AnyOrder(0.37));
}

TEST(Waves, ACompletelyTurnedRowHasNoMean) {
  // A whole period in each row: nothing acts on the average, whatever the samples at the rows say.
  test::KnownAxis axis;
  Signal& angle = axis.problem.signals->angle_rad;
  for (std::size_t k = 0; k < angle.size(); ++k)
    angle[k] = 2.0 * std::numbers::pi / 12.0 * static_cast<double>(k);
  const AxisModel m = test::With(axis, WaveEffect(axis.problem, Wave::kTorqueOfAngle, 12.0, 1.0), {0.0, 1.0});
  EXPECT_NEAR(test::MeanOverRow(m.motor_force, 100), 0.0, 1e-12);
  const AxisModel half =
      test::With(axis, WaveEffect(axis.problem, Wave::kTorqueOfAngle, 6.0, 1.0), {1.0, 0.0});
  // Half a period beginning at phase 100 pi: mean of a half wave.
  EXPECT_NEAR(test::MeanOverRow(half.motor_force, 100), 2.0 / std::numbers::pi, 1e-9);
}

TEST(Waves, TheTwoAmplitudesAreThoseOfSineAndCosine) {
  const test::KnownAxis axis;
  const SharedEffect e = WaveEffect(axis.problem, Wave::kTorqueOfAngle, 4.0, 1.0);
  for (const double phase : {-3.0, -0.4, 0.0, 1.3, 3.1}) {
    const NamedValues v = test::Told(axis, e, {2.0 * std::cos(phase), 2.0 * std::sin(phase)});
    EXPECT_NEAR(v.at("amplitude_Nm"), 2.0, 1e-12);
    EXPECT_NEAR(v.at("phase_rad"), phase, 1e-12);
  }
}

TEST(Waves, ParametersTakeTheirNamesAndTheirScale) {
  const test::KnownAxis axis;
  Point point;
  point.base.assign(axis.problem.terms.size(), 0.0);
  point.effects = {WaveEffect(axis.problem, Wave::kTorqueOfAngle, 4.0, 1.0)};
  point.amplitudes = {{3.0, 4.0}};
  const FittedEffect fitted{axis.problem, point, 0};
  EXPECT_NEAR(WaveParameters(fitted, "size", "order", 10.0).at("size"), 50.0, 1e-12);
  EXPECT_EQ(WaveParameters(fitted, "size", "order", 1.0).at("order"), 4.0);
  EXPECT_EQ(WaveParameters(fitted, "size", nullptr, 1.0).size(), 2u) << "size and phase";
}

TEST(Waves, APhaseToldAtAngleZeroIsThatOfTheWaveWhereverItsOrderTurns) {
  const test::KnownAxis axis;
  const SharedEffect e = WaveEffect(axis.problem, Wave::kFrictionOfAngle, 0.4, 1.0);
  // The middle of the travel is at 20 mm, two turns of the motor.
  EXPECT_NEAR(e->middle, 4.0 * std::numbers::pi, 1e-6);
  const NamedValues v = test::Told(axis, e, {1.0, 0.0, 0.01});
  EXPECT_NEAR(v.at("phase_rad"), -0.01 * e->middle, 1e-9);
}

TEST(Waves, AFreeOrderMovesByPeriodsOverTheTravelAndNoFurther) {
  const test::KnownAxis axis;
  const SharedEffect e = WaveEffect(axis.problem, Wave::kFrictionOfAngle, 0.4, 1.0);
  const double travel_rad = 20.0 * std::numbers::pi;
  ASSERT_EQ(e->steps.size(), 3u);
  EXPECT_LT(e->steps[2] * travel_rad, 0.1 * 2.0 * std::numbers::pi) << "a step is a small part of a period";
  EXPECT_NEAR(e->high[2], -e->low[2], 1e-12);
  EXPECT_LT(e->high[2] * travel_rad, 2.0 * 2.0 * std::numbers::pi);
  EXPECT_EQ(e->tested, 2u) << "the order itself is no size";
  EXPECT_EQ(WaveEffect(axis.problem, Wave::kTorqueOfAngle, 4.0, 1.0)->steps.size(), 2u)
      << "whole orders stay";
}

TEST(Waves, StepsAreSmallBesideFrictionAndReadings) {
  const test::KnownAxis axis;
  EXPECT_LT(WaveEffect(axis.problem, Wave::kTorqueOfAngle, 4.0, 1.0)->steps[0], 0.1 * 0.05);
  EXPECT_LT(WaveEffect(axis.problem, Wave::kForceOfTime, 4.5, 1.0)->steps[0], 0.1 * 0.05);
  EXPECT_NEAR(WaveEffect(axis.problem, Wave::kReadingOfAngle, 64.0, 1.0)->steps[0], axis.stated.position_step,
              1e-12);
}

TEST(Waves, OnlyForcesGoWithTheTorqueConstant) {
  const test::KnownAxis axis;
  EXPECT_EQ(WaveEffect(axis.problem, Wave::kTorqueOfAngle, 4.0, 1.0)->force, (std::vector<int>{1, 1}));
  EXPECT_EQ(WaveEffect(axis.problem, Wave::kForceOfTime, 4.5, 1.0)->force, (std::vector<int>{1, 1, 0}));
  EXPECT_TRUE(WaveEffect(axis.problem, Wave::kFrictionOfAngle, 2.0, 1.0)->force.empty());
  EXPECT_TRUE(WaveEffect(axis.problem, Wave::kReadingOfAngle, 64.0, 1.0)->force.empty());
}

}  // namespace
}  // namespace contour::diagnosis
