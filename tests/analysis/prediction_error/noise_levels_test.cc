#include "analysis/prediction_error/noise_levels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/analysis/support/noise_moved.h"

namespace contour::diagnosis {
namespace {

constexpr double kSlowMemory_rows = 20.0, kDensity = 100.0, kWhite_Nm = 0.002;

const Problem& Axis() { return test::SlidingAndStuck().problem; }
double Unit() { return Axis().stated.motor_inertia / std::pow(Axis().log.period_s, 2); }

std::shared_ptr<const LinearModel> Moved(double density) {
  const double white = kWhite_Nm * kWhite_Nm, keep = std::exp(-1.0 / kSlowMemory_rows);
  return test::MovedBy({white, test::ReadingVariance(), white * density * (1.0 - keep) / (1.0 + keep), keep});
}

NoiseLevels Likeliest(const LinearModel& model) {
  return LikeliestLevels(model, {Axis().counted, Axis().log.period_s, test::ReadingVariance(), Unit()},
                         nullptr);
}

TEST(NoiseLevels, FindASlowTorqueNextToWhiteOne) {
  const NoiseLevels levels = Likeliest(*Moved(kDensity));
  ASSERT_TRUE(levels.slow_there);
  EXPECT_NEAR(levels.log10_memory_rows, std::log10(kSlowMemory_rows), 0.35);
  EXPECT_NEAR(levels.log10_slow, std::log10(kDensity), 0.35);
  EXPECT_NEAR(levels.log10_torque, 2.0 * std::log10(kWhite_Nm / Unit()) - std::log10(test::ReadingVariance()),
              0.3);
}

TEST(NoiseLevels, AreThoseOfWhiteTorqueWhereThereIsNoOther) {
  const NoiseLevels levels = Likeliest(*Moved(0.0));
  EXPECT_FALSE(levels.slow_there);
  EXPECT_NEAR(levels.log10_torque, 2.0 * std::log10(kWhite_Nm / Unit()) - std::log10(test::ReadingVariance()),
              0.3);
}

// Several points are looked at together, and the search ends where one point after the other leads to.
TEST(NoiseLevels, AreLikelierThanThoseNextToThem) {
  const auto model = Moved(kDensity);
  const double one_reading = test::ReadingVariance();
  const auto unlikely = [&](const NoiseLevels& levels) {
    const std::size_t segments = 12, length = model->rows / segments;
    LikelihoodSums sums;
    for (std::size_t i = 0; i < segments; ++i) {
      const std::size_t from = (model->rows - length) * i / (segments - 1);
      KalmanPass({*model, Axis().counted, Axis().log.period_s, from, from + length},
                 VariancesOf(levels, one_reading, Unit()), sums, nullptr);
    }
    return sums.Unlikely();
  };
  const NoiseLevels first = Likeliest(*model);
  const NoiseLevels again =
      LikeliestLevels(*model, {Axis().counted, Axis().log.period_s, one_reading, Unit()}, &first);
  for (const NoiseLevels& levels : {first, again}) {
    const double least = unlikely(levels);
    for (double NoiseLevels::*number :
         {&NoiseLevels::log10_torque, &NoiseLevels::log10_slow, &NoiseLevels::log10_memory_rows})
      for (const double by : {-0.4, 0.4}) {
        NoiseLevels other = levels;
        other.*number += by;
        EXPECT_LT(least, unlikely(other)) << by;
      }
  }
}

TEST(NoiseLevels, OfFirstOrderTorqueHaveTheDensityOfTheirVariance) {
  const NoiseVariances v = VariancesOf(
      {.log10_torque = 0.0, .slow_there = true, .log10_slow = 2.0, .log10_memory_rows = 2.0}, 1.0, 3.0);
  EXPECT_DOUBLE_EQ(v.torque, 9.0);
  EXPECT_NEAR(v.keep, std::exp(-0.01), 1e-12);
  EXPECT_NEAR(v.slow * (1.0 + v.keep) / (1.0 - v.keep) / v.torque, 100.0, 1e-9);
  EXPECT_EQ(VariancesOf({}, 1.0, 3.0).slow, 0.0);
}

}  // namespace
}  // namespace contour::diagnosis
