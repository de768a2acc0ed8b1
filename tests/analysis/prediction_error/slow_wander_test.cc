#include "analysis/prediction_error/slow_wander.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace contour::diagnosis {
namespace {

const std::vector<std::size_t> kFromTheFirst = {0};

/// White noise of unit variance, and what wanders.
std::vector<double> Noise(std::size_t rows, const SlowWander& wander, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const double keep = std::exp(-1.0 / wander.memory_rows);
  double slow = std::sqrt(wander.variance) * normal(random);
  std::vector<double> out;
  for (std::size_t k = 0; k < rows; ++k) {
    out.push_back(slow + normal(random));
    slow = keep * slow + std::sqrt((1.0 - keep * keep) * wander.variance) * normal(random);
  }
  return out;
}

/// Scatter of the sums of blocks over what white noise has.
double ScatterOfBlocks(const std::vector<double>& x, std::size_t block) {
  double squares = 0.0;
  for (std::size_t from = 0; from + block <= x.size(); from += block) {
    double sum = 0.0;
    for (std::size_t k = from; k < from + block; ++k) sum += x[k];
    squares += sum * sum;
  }
  return squares / static_cast<double>(x.size() / block * block);
}

TEST(SlowWander, IsLearntWithinAFactorOfTwoOrSo) {
  const SlowWander truth{8000.0, 0.2};
  const std::vector<double> noise = Noise(100000, truth, 3);
  const SlowWander learnt = LearnSlowWander(noise, std::vector<double>(noise.size(), 1.0), kFromTheFirst);
  EXPECT_NEAR(std::log2(learnt.memory_rows / truth.memory_rows), 0.0, 1.5);
  EXPECT_NEAR(std::log2(learnt.variance / truth.variance), 0.0, 1.5);
}

TEST(SlowWander, WithoutItSecondsAreWhite) {
  std::vector<double> noise = Noise(100000, {8000.0, 0.2}, 4);
  const std::vector<double> weight(noise.size(), 1.0);
  EXPECT_GT(ScatterOfBlocks(noise, 2000), 50.0);
  const SlowWander learnt = LearnSlowWander(noise, weight, kFromTheFirst);
  double* const column = noise.data();
  TakeOutWander(learnt, weight, kFromTheFirst, 1.0, std::span(&column, 1));
  EXPECT_NEAR(ScatterOfBlocks(noise, 2000), 1.0, 0.5);
  EXPECT_NEAR(ScatterOfBlocks(noise, 1), 1.0, 0.05);
}

TEST(SlowWander, HowManyColumnsThereAreChangesNone) {
  const SlowWander wander{100.0, 0.2};
  std::vector<double> weight;
  for (int k = 0; k < 300; ++k) weight.push_back(k % 7 == 0 ? 0.0 : 1.0 + 0.01 * k);
  for (std::size_t count = 1; count < 20; ++count) {
    std::vector<std::vector<double>> together, alone;
    for (std::size_t i = 0; i < count; ++i)
      together.push_back(Noise(weight.size(), wander, static_cast<unsigned>(i)));
    alone = together;
    std::vector<double*> columns;
    for (std::vector<double>& column : together) columns.push_back(column.data());
    TakeOutWander(wander, weight, kFromTheFirst, 1.0, columns);
    for (std::vector<double>& column : alone) {
      double* const one = column.data();
      TakeOutWander(wander, weight, kFromTheFirst, 1.0, std::span(&one, 1));
    }
    EXPECT_EQ(together, alone) << count;
  }
}

TEST(SlowWander, WhiteNoiseHasNearlyNone) {
  const std::vector<double> noise = Noise(50000, {1.0, 0.0}, 5);
  const std::vector<double> weight(noise.size(), 1.0);
  const SlowWander learnt = LearnSlowWander(noise, weight, kFromTheFirst);
  // What would be there lowers no sum over a second by more than a few parts in a hundred.
  EXPECT_LT(learnt.variance, 2e-3);
}

TEST(SlowWander, IsTheExactLikelihoodOfItsCovariance) {
  const SlowWander wander{5.0, 0.7};
  const std::vector<double> weight = {1.0, 0.5, 0.0, 1.5, 1.0, 0.8};
  const auto n = static_cast<Eigen::Index>(weight.size());
  std::vector<double> reading = {0.3, -0.2, 7.0, 1.1, 0.4, -0.9};
  // Rows that count: noise of the reading of variance 1 / w^2, next to what wanders.
  std::vector<Eigen::Index> counts;
  for (Eigen::Index i = 0; i < n; ++i)
    if (weight[static_cast<std::size_t>(i)] > 0.0) counts.push_back(i);
  const auto m = static_cast<Eigen::Index>(counts.size());
  Eigen::MatrixXd covariance(m, m);
  Eigen::VectorXd y(m);
  double by_weights = 0.0;
  for (Eigen::Index i = 0; i < m; ++i) {
    const auto a = static_cast<std::size_t>(counts[static_cast<std::size_t>(i)]);
    y(i) = reading[a];
    by_weights -= 2.0 * std::log(weight[a]);
    for (Eigen::Index j = 0; j < m; ++j) {
      const auto b = static_cast<std::size_t>(counts[static_cast<std::size_t>(j)]);
      const double apart = std::fabs(static_cast<double>(a) - static_cast<double>(b));
      covariance(i, j) =
          wander.variance * std::exp(-apart / wander.memory_rows) + (i == j ? std::pow(weight[a], -2) : 0.0);
    }
  }
  std::vector<double> weighted = reading;
  for (std::size_t k = 0; k < weighted.size(); ++k) weighted[k] *= weight[k];
  double* const column = weighted.data();
  TakeOutWander(wander, weight, kFromTheFirst, 1.0, std::span(&column, 1));
  double squares = 0.0;
  for (const double x : weighted) squares += x * x;
  EXPECT_NEAR(squares, y.dot(covariance.ldlt().solve(y)), 1e-9);
  EXPECT_NEAR(LogVariances(wander, weight, kFromTheFirst) + by_weights, std::log(covariance.determinant()),
              1e-9);
}

TEST(SlowWander, NothingGoesFromOnePieceOfALogToTheNext) {
  const SlowWander wander{100.0, 3.0};
  const std::vector<double> weight(60, 1.0);
  std::vector<double> both(60, 0.0), second(60, 0.0);
  for (std::size_t k = 0; k < 30; ++k) both[k] = 5.0;
  for (std::size_t k = 30; k < 60; ++k) both[k] = second[k] = 1.0;
  double* const columns[] = {both.data(), second.data()};
  const std::vector<std::size_t> begins = {0, 30};
  TakeOutWander(wander, weight, begins, 1.0, columns);
  for (std::size_t k = 30; k < 60; ++k) EXPECT_DOUBLE_EQ(both[k], second[k]);
}

}  // namespace
}  // namespace contour::diagnosis
