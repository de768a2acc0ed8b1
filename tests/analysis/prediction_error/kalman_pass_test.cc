#include "analysis/prediction_error/kalman_pass.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/support/noise_moved.h"

namespace contour::diagnosis {
namespace {

NoiseVariances Noise(double slow_over_white) {
  const double white = 4e-6;
  return {white, test::ReadingVariance(), slow_over_white * white, 0.95};
}

PassRows All(const LinearModel& model) {
  const Problem& problem = test::SlidingAndStuck().problem;
  return {model, problem.counted, problem.log.period_s, 0, model.rows};
}

double Unlikely(const LinearModel& model, const NoiseVariances& noise) {
  LikelihoodSums sums;
  KalmanPass(All(model), noise, sums, nullptr);
  return sums.Unlikely();
}

TEST(KalmanPass, TheTrueVariancesAreLikelierThanOthers) {
  const auto model = test::MovedBy(Noise(2.0));
  const double at_truth = Unlikely(*model, Noise(2.0));
  EXPECT_LT(at_truth, Unlikely(*model, Noise(0.0)) - 100.0);
  EXPECT_LT(at_truth, Unlikely(*model, Noise(0.5)) - 10.0);
  EXPECT_LT(at_truth, Unlikely(*model, Noise(8.0)) - 10.0);
}

// The torque that moves it is held over a row, and has no slope there as the filter's has.
TEST(KalmanPass, InnovationsHaveTheVarianceThatTheyAreDividedBy) {
  const auto model = test::MovedBy(Noise(2.0));
  LikelihoodSums sums;
  KalmanPass(All(*model), Noise(2.0), sums, nullptr);
  EXPECT_NEAR(sums.squares / sums.count, 1.0, 0.05);
}

TEST(KalmanPass, ASlowTorqueThatIsNearlyNoneChangesNoGain) {
  const auto model = test::MovedBy(Noise(0.0));
  const auto n = static_cast<std::size_t>(model->states);
  EXPECT_EQ(FilterStates(*model, Noise(0.0)), model->states);
  EXPECT_EQ(FilterStates(*model, Noise(1e-12)), model->states + 1);
  std::vector<float> without((model->rows - 1) * (n + 1)), with((model->rows - 1) * (n + 2));
  LikelihoodSums sums;
  KalmanPass(All(*model), Noise(0.0), sums, without.data());
  KalmanPass(All(*model), Noise(1e-12), sums, with.data());
  for (std::size_t k = 0; k + 1 < model->rows; k += 97) {
    const float* a = &without[k * (n + 1)];
    const float* b = &with[k * (n + 2)];
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(a[i], b[i], 1e-4F * (1.0F + std::fabs(a[i]))) << k;
    EXPECT_NEAR(a[n], b[n + 1], 1e-4F * a[n]) << k;
  }
}

TEST(StatesAlone, AreTheTransitionsWithoutInputs) {
  const LinearModel& model = test::SlidingAndStuck().problem.noise.linear();
  const auto n = static_cast<std::size_t>(model.states);
  const std::vector<float> alone = StatesAlone(model);
  ASSERT_EQ(alone.size(), (model.rows - 1) * n * (n + 1));
  for (std::size_t k = 0; k + 1 < model.rows; k += 97)
    for (std::size_t i = 0; i < n * (n + 1); ++i)
      ASSERT_EQ(alone[k * n * (n + 1) + i], model.step[k * model.stride + i]) << k;
}

TEST(WithSlowTorque, ActsAsTheMotorsForceDoes) {
  const LinearModel& model = test::SlidingAndStuck().problem.noise.linear();
  const auto own = static_cast<std::size_t>(model.states), n = own + 1;
  const std::vector<float> wide = WithSlowTorque(model, 0.5);
  ASSERT_EQ(wide.size(), (model.rows - 1) * n * (n + 1));
  const std::size_t k = 12345;
  const float* narrow = &model.step[k * model.stride];
  const float* in = narrow + own * own + 2 * own;
  const float* at = &wide[k * n * (n + 1)];
  for (std::size_t i = 0; i < own; ++i) {
    for (std::size_t j = 0; j < own; ++j) EXPECT_EQ(at[i * n + j], narrow[i * own + j]);
    EXPECT_FLOAT_EQ(at[i * n + own], in[1 + i] + 0.5F * in[own + 2 + i]);
    EXPECT_EQ(at[own * n + i], 0.0F);
    EXPECT_EQ(at[n * n + i], narrow[own * own + i]);
  }
  EXPECT_EQ(at[own * n + own], 0.5F);
  EXPECT_FLOAT_EQ(at[n * n + own], in[0] + 0.5F * in[own + 1]);
}

}  // namespace
}  // namespace contour::diagnosis
