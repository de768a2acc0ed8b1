#include "analysis/prediction_error/noise_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "tests/analysis/support/learnt_problem.h"
#include "tests/analysis/support/noise_moved.h"

namespace contour::diagnosis {
namespace {

test::HiddenOptions Options() {
  test::HiddenOptions o;
  o.seed = 3;
  o.duration_s = 30.0;
  o.parameter_spread = 0.0;
  o.scale = false;
  return o;
}

const test::LearntProblem& Made() {
  static const test::LearntProblem made(test::MakeHiddenAxis(Options()));
  return made;
}

double MeanProduct(const std::vector<double>& x, const std::vector<std::uint8_t>& counted, std::size_t lag) {
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k + lag < x.size(); ++k)
    if (counted[k] != 0 && counted[k + lag] != 0) {
      sum += x[k] * x[k + lag];
      count += 1.0;
    }
  return sum / count;
}

// With the true numbers what is left is noise: white, of unit variance.
TEST(NoiseFilter, TheTrueModelLeavesWhiteNoiseOfUnitVariance) {
  const Problem& problem = Made().problem;
  const std::vector<double> white = problem.Residuals(std::span(&Made().point, 1))[0];
  const double power = MeanProduct(white, problem.counted, 0);
  EXPECT_NEAR(power, 1.0, 0.2);
  for (const std::size_t lag : {1U, 2U, 10U})
    EXPECT_LT(std::fabs(MeanProduct(white, problem.counted, lag)), 0.1 * power) << lag;
}

// The noise that nobody commanded: 0.5 % of the rated torque, white per row.
TEST(NoiseFilter, FindsTheNoiseOfTheTorque) {
  EXPECT_NEAR(Made().problem.noise.torque_noise() / (0.005 * Made().axis.stated.rated), 1.0, 0.3);
}

// Of a double integrator: sqrt(s T^2 / (J r)) / (2 pi T), s and r the deviations of torque and reading.
TEST(NoiseFilter, TheObserversBandwidthIsThatOfTheTwoNoises) {
  const Problem& problem = Made().problem;
  const double T = problem.log.period_s, unit = problem.stated.motor_inertia / (T * T);
  const double reading = problem.stated.position_step / std::sqrt(12.0);
  const double expected =
      std::sqrt(0.005 * problem.stated.rated / unit / reading) / (2.0 * std::numbers::pi * T);
  EXPECT_NEAR(problem.noise.ObserverBandwidth_Hz(T) / expected, 1.0, 0.3);
}

TEST(NoiseFilter, WhitensInProportion) {
  const Problem& problem = Made().problem;
  const std::vector<double> weight(problem.rows(), 1.0);
  std::vector<double> x(problem.rows()), y(problem.rows()), white_x(problem.rows()), white_y(problem.rows());
  for (std::size_t k = 0; k < x.size(); ++k) {
    x[k] = std::sin(0.05 * static_cast<double>(k));
    y[k] = -2.5 * x[k];
  }
  const double* in[] = {x.data(), y.data()};
  double* out[] = {white_x.data(), white_y.data()};
  problem.noise.Apply(in, out, problem.counted, weight.data());
  for (std::size_t k = 0; k < x.size(); k += 31)
    EXPECT_NEAR(white_y[k], -2.5 * white_x[k], 1e-9 * (1.0 + std::fabs(white_y[k])));
}

// Back() is the gradient: a little more force changes |white|^2 / 2 by it.
TEST(NoiseFilter, BackIsTheGradientOfTheSquaresWithRespectToSignals) {
  const Problem& problem = Made().problem;
  const std::vector<double> white = problem.Residuals(std::span(&Made().point, 1))[0];
  const NoiseFilter::Gradient gradient =
      problem.noise.Back(white, problem.counted, problem.root_weight.data());
  const std::size_t row = 12000, length = 400;
  std::vector<double> pulse = problem.noise.Pulse(row, false, length, problem.counted);
  double along = 0.0;
  for (std::size_t i = 0; i < pulse.size(); ++i)
    along += pulse[i] * white[row + 1 + i] * problem.root_weight[row + 1 + i];
  ASSERT_NE(along, 0.0);
  EXPECT_NEAR(gradient.motor[row] / along, 1.0, 0.05);
}

/// What the filters make of a pulse, row by row of the whole log.
std::vector<double> PulseInWholeLog(std::size_t row, bool reading) {
  const Problem& problem = Made().problem;
  const std::size_t n = problem.rows();
  auto pulse = std::make_shared<Signal>(reading ? n : 2 * n, 0.0);
  (*pulse)[row] = 1.0;
  if (!reading) (*pulse)[n + row] = 1.0;
  LinearInput input;
  (reading ? input.reading_error : input.motor_force) = pulse;
  const FilterRun run = LinearColumns(problem.noise.linear(), std::span(&input, 1), false)[0];
  std::vector<double> white(n);
  const std::vector<double> weight(n, 1.0);
  const double* in[] = {run.innovation.data()};
  double* out[] = {white.data()};
  problem.noise.Apply(in, out, problem.counted, weight.data());
  return white;
}

TEST(NoiseFilter, APulseIsThatOfTheWholeLogBitForBit) {
  const Problem& problem = Made().problem;
  constexpr std::size_t kLength = 60;
  for (const std::size_t row : {std::size_t{0}, std::size_t{1}, std::size_t{12000}, problem.rows() - 20})
    for (const bool reading : {false, true}) {
      const std::vector<double> whole = PulseInWholeLog(row, reading);
      const std::vector<double> pulse = problem.noise.Pulse(row, reading, kLength, problem.counted);
      ASSERT_EQ(pulse.size(), kLength);
      const std::size_t first = reading ? row : row + 1;
      for (std::size_t i = 0; i < kLength; ++i)
        ASSERT_EQ(pulse[i], first + i < whole.size() ? whole[first + i] : 0.0)
            << row << " " << reading << " " << i;
    }
}

std::shared_ptr<const LinearModel> MovedBySlowTorque() {
  return test::MovedBy({4e-6, test::ReadingVariance(), 1e-5, 0.95});
}

NoiseFilter FilterOf(std::shared_ptr<const LinearModel> model, bool slow_torque = true) {
  const Problem& problem = test::SlidingAndStuck().problem;
  return {std::move(model),
          problem.counted,
          {problem.stated.motor_inertia, problem.log.period_s, problem.stated.position_step, slow_torque},
          nullptr};
}

/// By how much more than white noise the score of a level of friction scatters in blocks of a second, those
/// that know more of it counting more.
double ScatterOfLevel(const std::shared_ptr<const LinearModel>& model, bool slow_torque) {
  const Problem& problem = test::SlidingAndStuck().problem;
  LinearInput level;
  level.level = std::make_shared<Signal>(model->rows, 1.0);
  const FilterRun run = LinearColumns(*model, std::span(&level, 1), false)[0];
  std::vector<double> noise(model->rows), column(model->rows);
  const std::vector<double> weight(model->rows, 1.0);
  const double* in[] = {model->innovation.data(), run.innovation.data()};
  double* out[] = {noise.data(), column.data()};
  FilterOf(model, slow_torque).Apply(in, out, problem.counted, weight.data());
  double scatter = 0.0, information = 0.0;
  for (std::size_t from = 0; from + 1000 <= model->rows; from += 1000) {
    double product = 0.0;
    for (std::size_t k = from; k < from + 1000; ++k) {
      product += noise[k] * column[k];
      information += column[k] * column[k];
    }
    scatter += product * product;
  }
  const double power = MeanProduct(noise, problem.counted, 0);
  return scatter / (information * power);
}

// Behind a filter that knows white torque alone the colour filter is one for sliding and sticking: the score
// scatters about twice as much as it should.
TEST(NoiseFilter, ALevelOfFrictionScattersAsItsInformationSaysUnderASlowTorque) {
  const std::shared_ptr<const LinearModel> model = test::MovedBy({1e-7, test::ReadingVariance(), 1e-3, 0.98});
  const double with_slow = ScatterOfLevel(model, true);
  EXPECT_GT(with_slow, 0.5);
  EXPECT_LT(with_slow, 1.4);
  EXPECT_GT(ScatterOfLevel(model, false), 1.5 * with_slow);
}

// Back() is the gradient with one more state, too.
TEST(NoiseFilter, BackIsTheGradientUnderASlowTorque) {
  const Problem& problem = test::SlidingAndStuck().problem;
  const std::shared_ptr<const LinearModel> model = MovedBySlowTorque();
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

TEST(ColourFilter, TakesTheWhitenersTaps) {
  const std::vector<double> x = {1.0, 0.0, 0.0, 2.0};
  const std::vector<std::uint8_t> counted = {1, 1, 1, 0};
  const std::vector<double> weight = {1.0, 1.0, 1.0, 1.0};
  std::vector<double> out(4);
  const double* in[] = {x.data()};
  double* to[] = {out.data()};
  ApplyColourFilter(Whitener(), in, to, counted, weight.data());
  EXPECT_EQ(out, (std::vector<double>{1.0, 0.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace contour::diagnosis
