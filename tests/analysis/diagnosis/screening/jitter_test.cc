#include "analysis/diagnosis/screening/jitter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <utility>

#include "analysis/diagnosis/screening/score.h"
#include "analysis/diagnosis/tuning/statistics.h"
#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

test::HiddenOptions Long(std::vector<test::HiddenEffect> effects) {
  test::HiddenOptions o = test::FittedAxis::Short(std::move(effects));
  o.duration_s = 20.0;
  return o;
}

TEST(Jitter, OfTheInstantsIsFoundWithItsSize) {
  const test::FittedAxis axis(Long({{"sample_jitter", 14.0, 0.0, 0.0, 0.0}}));
  const Jitter jitter = TestJitter(axis.problem, axis.base);
  ASSERT_TRUE(jitter.tested);
  EXPECT_GT(jitter.drop, 50.0);
  EXPECT_NEAR(jitter.rms_s, 14e-6, 2e-6);
  EXPECT_LT(jitter.sigma_s, 0.2 * jitter.rms_s);
}

TEST(Jitter, IsFoundWhereTheEncodersCountsAreNotStated) {
  test::FittedAxis axis(Long({{"sample_jitter", 14.0, 0.0, 0.0, 0.0}}));
  axis.made.axis.stated.position_step = 0.0;
  const Jitter jitter = TestJitter(axis.problem, axis.base);
  ASSERT_TRUE(jitter.tested);
  EXPECT_GT(jitter.drop, 50.0);
  EXPECT_NEAR(jitter.rms_s, 14e-6, 2e-6);
}

TEST(Jitter, IsNotFoundWhereReadingsAreInTime) {
  const test::FittedAxis axis(Long({}));
  const Jitter jitter = TestJitter(axis.problem, axis.base);
  ASSERT_TRUE(jitter.tested);
  EXPECT_LT(jitter.drop, 20.0);
  EXPECT_LT(jitter.rms_s, 5e-6);
}

TEST(Jitter, RoundingIsNone) {
  // From five counts per row at the highest speed to fifty.
  for (const double step_rad : {0.05, 0.02, 0.005}) {
    test::HiddenOptions coarse = Long({});
    coarse.encoder_step_rad = step_rad;
    const test::FittedAxis axis(coarse);
    const Jitter jitter = TestJitter(axis.problem, axis.base);
    EXPECT_TRUE(jitter.tested) << step_rad;
    EXPECT_LT(jitter.drop, 9.0) << step_rad;
  }
}

// At a whole number of counts per row the rounding error stays as it is, half-way between two it is largest.
TEST(Jitter, RoundingThatIsAlikeAtOneSpeedIsNone) {
  test::FittedAxis axis(Long({}));
  const Problem& problem = axis.problem;
  double gain = 0.0, last = 0.0, before = 0.0;
  for (const double h : PulseResponse(problem, true)) {
    gain += std::pow(h - 2.0 * last + before, 2) / kVarianceOfSecondDifference;
    before = std::exchange(last, h);
  }
  const double counts_per_row[] = {3.05, 4.3, 7.4, 9.5}, step = problem.stated.position_step;
  Fit fit = axis.base;
  double counts = 0.0;
  for (std::size_t k = 0; k < problem.rows(); ++k) {
    const double speed = counts_per_row[k / 250 % std::size(counts_per_row)];
    counts += speed;
    problem.signals->velocity[k] = speed * step / problem.log.period_s;
    problem.signals->acceleration[k] = 0.0;
    fit.residual[k] = (std::round(counts) - counts) * step * std::sqrt(gain) * problem.root_weight[k];
  }
  const Jitter jitter = TestJitter(problem, fit);
  ASSERT_TRUE(jitter.tested);
  EXPECT_LT(jitter.drop, 9.0);
}

TEST(Jitter, BelowTheRoundingOfTheEncoderIsFound) {
  const double jitter_s = 14e-6;
  test::HiddenOptions o = Long({{"sample_jitter", jitter_s * 1e6, 0.0, 0.0, 0.0}});
  o.encoder_step_rad = 5.0 * jitter_s * test::FittedAxis(o).problem.signals->max_speed;
  const test::FittedAxis axis(o);
  ASSERT_GT(o.encoder_step_rad * std::sqrt(kUniformVariance),
            1.4 * jitter_s * axis.problem.signals->max_speed);
  const Jitter jitter = TestJitter(axis.problem, axis.base);
  EXPECT_GT(jitter.drop, 9.0);
  EXPECT_NEAR(jitter.rms_s, jitter_s, 0.3 * jitter_s);
}

TEST(Jitter, OneSpeedAloneCannotTell) {
  const test::FittedAxis axis(Long({}));
  axis.problem.signals->velocity.assign(axis.problem.rows(), 30.0);
  EXPECT_FALSE(TestJitter(axis.problem, axis.base).tested);
  // Rest neither: quantisation is no noise.
  axis.problem.signals->velocity.assign(axis.problem.rows(), 0.0);
  EXPECT_FALSE(TestJitter(axis.problem, axis.base).tested);
}

}  // namespace
}  // namespace contour::diagnosis
