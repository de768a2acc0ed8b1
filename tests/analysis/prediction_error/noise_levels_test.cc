#include "analysis/prediction_error/noise_levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "analysis/prediction_error/noise_filter.h"
#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

constexpr double kSlowMemory_rows = 20.0, kDensity = 100.0, kWhite_Nm = 0.002;

test::HiddenOptions Options() {
  test::HiddenOptions o;
  o.seed = 5;
  o.duration_s = 40.0;
  o.parameter_spread = 0.0;
  o.scale = false;
  return o;
}

const test::LearntProblem& Made() {
  static const test::LearntProblem made(test::MakeHiddenAxis(Options()));
  return made;
}

double Reading() { return std::pow(Made().problem.stated.position_step, 2) / 12.0; }
double Unit() { return Made().problem.stated.motor_inertia / std::pow(Made().problem.log.period_s, 2); }

/// An axis that slides and sticks, moved by noise alone: white torque, first-order torque, rounding.
std::shared_ptr<const LinearModel> Moved(double density) {
  const Problem& problem = Made().problem;
  auto model = std::make_shared<LinearModel>(problem.noise.linear());
  const std::size_t n = model->rows;
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  const double keep = std::exp(-1.0 / kSlowMemory_rows);
  const double deviation = kWhite_Nm * std::sqrt(density * (1.0 - keep) / (1.0 + keep));
  LinearInput input;
  auto torque = std::make_shared<Signal>(2 * n), reading = std::make_shared<Signal>(n);
  double slow = deviation * normal(random);
  for (std::size_t k = 0; k < n; ++k) {
    const double next = keep * slow + deviation * std::sqrt(1.0 - keep * keep) * normal(random);
    const double white = kWhite_Nm * normal(random);
    (*torque)[k] = white + slow;
    (*torque)[n + k] = white + next;
    slow = next;
    (*reading)[k] = std::sqrt(Reading()) * normal(random);
  }
  input.motor_force = torque;
  input.reading_error = reading;
  model->innovation = LinearColumns(*model, std::span(&input, 1), false)[0].innovation;
  return model;
}

NoiseLevels Likeliest(const LinearModel& model) {
  return LikeliestLevels(model, Made().problem.counted, Made().problem.log.period_s, Reading(), Unit(),
                         nullptr);
}

TEST(NoiseLevels, FindASlowTorqueNextToWhiteOne) {
  const NoiseLevels levels = Likeliest(*Moved(kDensity));
  ASSERT_TRUE(levels.slow_there);
  EXPECT_NEAR(levels.memory, std::log10(kSlowMemory_rows), 0.35);
  EXPECT_NEAR(levels.slow, std::log10(kDensity), 0.35);
  EXPECT_NEAR(levels.torque, 2.0 * std::log10(kWhite_Nm / Unit()) - std::log10(Reading()), 0.3);
}

TEST(NoiseLevels, AreThoseOfWhiteTorqueWhereThereIsNoOther) {
  const NoiseLevels levels = Likeliest(*Moved(0.0));
  EXPECT_FALSE(levels.slow_there);
  EXPECT_NEAR(levels.torque, 2.0 * std::log10(kWhite_Nm / Unit()) - std::log10(Reading()), 0.3);
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
  const Problem& problem = Made().problem;
  return {std::move(model),
          problem.counted,
          problem.stated.motor_inertia,
          problem.log.period_s,
          problem.stated.position_step,
          nullptr};
}

// Of a constant torque and of a level of friction, in blocks of a second: what scatters as white noise would
// has a sum of squares as large as its information. The slow torque moves a stuck axis, and says when it
// breaks away; a filter after one that knows white torque alone cannot tell.
TEST(NoiseFilter, ScoresScatterAsTheirInformationSaysUnderASlowTorque) {
  const Problem& problem = Made().problem;
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
  const Problem& problem = Made().problem;
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
