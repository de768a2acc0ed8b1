#include "daemon/memory/stroke_friction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace contour {
namespace {

constexpr StrokeFriction::Stroke kStroke{-0.2, 0.2, 5e-3};
using Level = std::function<double(double position_m, double time_s)>;

/// Back and forth at one speed, seen by an estimator that follows the level with a delay.
void Travel(StrokeFriction& friction, const Level& level_N, double speed_m_s, int passes,
            double delay_s = 0.0) {
  double time_s = 0.0;
  double position_m = -0.19;
  for (int pass = 0; pass < passes; ++pass) {
    const double velocity_m_s = pass % 2 == 0 ? speed_m_s : -speed_m_s;
    for (int k = 0; k < static_cast<int>(0.38 / speed_m_s * 1e3); ++k) {
      friction.Add({position_m, velocity_m_s, level_N(position_m - velocity_m_s * delay_s, time_s), true});
      position_m += velocity_m_s * 1e-3;
      time_s += 1e-3;
    }
    friction.Add({position_m, 0.0, level_N(position_m, time_s), true});
  }
}

double Wave(double position_m) { return 1.0 + 0.2 * std::sin(2.0 * M_PI * position_m / 0.2); }

double LargestError(const StrokeFriction& friction, const std::function<double(double)>& truth) {
  double mean = 0.0;
  for (std::size_t i = 0; i < friction.pieces(); ++i)
    mean += truth(friction.Centre_m(i)) / static_cast<double>(friction.pieces());
  const std::vector<double> found = friction.Relative();
  double largest = 0.0;
  // The axis does not get into the first and the last piece as a whole.
  for (std::size_t i = 1; i + 1 < friction.pieces(); ++i)
    largest = std::max(largest, std::abs(found[i] - (truth(friction.Centre_m(i)) / mean - 1.0)));
  return largest;
}

TEST(StrokeFriction, KnowsNothingAtFirst) {
  const StrokeFriction friction(kStroke);
  EXPECT_EQ(friction.pieces(), 32u);
  for (const double r : friction.Relative()) EXPECT_EQ(r, 0.0);
}

TEST(StrokeFriction, FindsTheShapeAndNotTheLevel) {
  for (const double level_N : {20.0, 60.0}) {
    StrokeFriction friction(kStroke);
    Travel(
        friction, [=](double p, double) { return level_N * Wave(p); }, 0.05, 4);
    EXPECT_LT(LargestError(friction, Wave), 0.02);
  }
}

TEST(StrokeFriction, FrictionThatDriftsAsAWholeIsNoShape) {
  StrokeFriction friction(kStroke);
  Travel(
      friction, [](double, double t) { return 40.0 * std::exp(0.02 * t); }, 0.1, 6);
  for (const double r : friction.Relative()) EXPECT_LT(std::abs(r), 0.005);
}

TEST(StrokeFriction, ADelayedEstimateDoesNotMoveTheMap) {
  StrokeFriction friction(kStroke);
  Travel(
      friction, [](double p, double) { return 40.0 * Wave(p); }, 0.05, 6, 0.1);
  EXPECT_LT(LargestError(friction, Wave), 0.03);
}

TEST(StrokeFriction, OneDirectionAloneTeachesNothing) {
  StrokeFriction friction(kStroke);
  for (int i = 0; i < 4; ++i) {
    Travel(
        friction, [](double p, double) { return 40.0 * Wave(p); }, 0.05, 1);
    friction.Add({0.0, 0.0, 40.0, false});
  }
  EXPECT_GT(friction.passes(), 0u);
  for (const double r : friction.Relative()) EXPECT_EQ(r, 0.0);
}

TEST(StrokeFriction, NeitherStopsNorOtherSpeedsNorCreepingAreSteps) {
  StrokeFriction creeping(kStroke);
  Travel(
      creeping, [](double p, double) { return 40.0 * Wave(p); }, 0.003, 2);
  EXPECT_EQ(creeping.passes(), 0u);
  StrokeFriction uneven(kStroke);
  // Another speed in every piece.
  double position_m = -0.19;
  for (int k = 0; position_m < 0.19; ++k) {
    const auto piece = static_cast<int>((position_m + 0.2) / 0.0125);
    const double velocity_m_s = piece % 2 == 0 ? 0.02 : 0.04;
    uneven.Add({position_m, velocity_m_s, 40.0, true});
    position_m += velocity_m_s * 1e-3;
  }
  EXPECT_EQ(uneven.passes(), 0u);
}

TEST(StrokeFriction, GoesOnFromWhatItKnows) {
  StrokeFriction before(kStroke);
  Travel(
      before, [](double p, double) { return 40.0 * Wave(p); }, 0.05, 4);
  StrokeFriction after(kStroke, before.steps());
  Travel(
      after, [](double p, double) { return 35.0 * Wave(p); }, 0.05, 1);
  EXPECT_GT(after.passes(), 0u);
  EXPECT_LT(LargestError(after, Wave), 0.02);
  EXPECT_THROW(StrokeFriction(kStroke, std::vector<StrokeFriction::Step>(3)), std::invalid_argument);
}

}  // namespace
}  // namespace contour
