#include "analysis/prediction_error/noise_levels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "analysis/prediction_error/noise_filter.h"
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
  EXPECT_NEAR(levels.memory, std::log10(kSlowMemory_rows), 0.35);
  EXPECT_NEAR(levels.slow, std::log10(kDensity), 0.35);
  EXPECT_NEAR(levels.torque, 2.0 * std::log10(kWhite_Nm / Unit()) - std::log10(test::ReadingVariance()), 0.3);
}

TEST(NoiseLevels, AreThoseOfWhiteTorqueWhereThereIsNoOther) {
  const NoiseLevels levels = Likeliest(*Moved(0.0));
  EXPECT_FALSE(levels.slow_there);
  EXPECT_NEAR(levels.torque, 2.0 * std::log10(kWhite_Nm / Unit()) - std::log10(test::ReadingVariance()), 0.3);
}

TEST(NoiseLevels, OfFirstOrderTorqueHaveTheDensityOfTheirVariance) {
  const NoiseVariances v =
      VariancesOf({.torque = 0.0, .slow_there = true, .slow = 2.0, .memory = 2.0}, 1.0, 3.0);
  EXPECT_DOUBLE_EQ(v.torque, 9.0);
  EXPECT_NEAR(v.keep, std::exp(-0.01), 1e-12);
  EXPECT_NEAR(v.slow * (1.0 + v.keep) / (1.0 - v.keep) / v.torque, 100.0, 1e-9);
  EXPECT_EQ(VariancesOf({}, 1.0, 3.0).slow, 0.0);
}

NoiseFilter FilterOf(std::shared_ptr<const LinearModel> model) {
  const Problem& problem = Axis();
  return {std::move(model),
          problem.counted,
          {problem.stated.motor_inertia, problem.log.period_s, problem.stated.position_step},
          nullptr};
}

// Of a constant torque and of a level of friction, in blocks of a second: what scatters as white noise would
// has a sum of squares as large as its information. The slow torque moves a stuck axis, and says when it
// breaks away; a filter after one that knows white torque alone cannot tell.
TEST(NoiseFilter, ScoresScatterAsTheirInformationSaysUnderASlowTorque) {
  const Problem& problem = Axis();
  const std::shared_ptr<const LinearModel> model = Moved(kDensity);
  const NoiseFilter filter = FilterOf(model);
  LinearInput inputs[2];
  inputs[0].motor_force = std::make_shared<Signal>(model->rows, 1.0);
  inputs[1].level = std::make_shared<Signal>(model->rows, 1.0);
  const std::vector<FilterRun> runs = LinearColumns(*model, inputs, false);
  std::vector<std::vector<double>> white(3, std::vector<double>(model->rows));
  const std::vector<double> weight(model->rows, 1.0);
  const double* in[] = {model->innovation.data(), runs[0].innovation.data(), runs[1].innovation.data()};
  double* out[] = {white[0].data(), white[1].data(), white[2].data()};
  filter.Apply(in, out, problem.counted, weight.data());
  for (const std::size_t column : {1U, 2U}) {
    double scatter = 0.0, count = 0.0;
    for (std::size_t from = 1000; from + 1000 <= model->rows; from += 1000) {
      double product = 0.0, information = 0.0, square = 0.0;
      for (std::size_t k = from; k < from + 1000; ++k) {
        product += white[0][k] * white[column][k];
        information += white[column][k] * white[column][k];
        square += white[0][k] * white[0][k] / 1000.0;
      }
      if (!(information > 0.0)) continue;
      scatter += product * product / (information * square);
      count += 1.0;
    }
    EXPECT_LT(scatter / count, 1.8) << column;
    EXPECT_GT(scatter / count, 0.4) << column;
  }
}

// Back() is the gradient with one more state, too.
TEST(NoiseFilter, BackIsTheGradientUnderASlowTorque) {
  const Problem& problem = Axis();
  const std::shared_ptr<const LinearModel> model = Moved(kDensity);
  const NoiseFilter filter = FilterOf(model);
  const std::vector<double> weight(model->rows, 1.0);
  std::vector<double> white(model->rows);
  const double* in[] = {model->innovation.data()};
  double* out[] = {white.data()};
  filter.Apply(in, out, problem.counted, weight.data());
  const NoiseFilter::Gradient gradient = filter.Back(white, problem.counted, weight.data());
  for (const std::size_t row : {8000U, 20000U}) {
    const std::vector<double> pulse = filter.Pulse(row, false, 1500, problem.counted);
    double along = 0.0;
    for (std::size_t i = 0; i < pulse.size(); ++i) along += pulse[i] * white[row + 1 + i];
    EXPECT_NEAR(gradient.motor[row], along, 0.05 * std::fabs(along)) << row;
  }
}

}  // namespace
}  // namespace contour::diagnosis
