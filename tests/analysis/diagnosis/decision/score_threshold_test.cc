#include "analysis/diagnosis/decision/score_threshold.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/analysis/support/fitted_axis.h"
#include "tests/analysis/support/known_axis.h"

namespace contour::diagnosis {
namespace {

/// A candidate of some amplitudes whose blocks are white: no effect.
Scored OfChance(int amplitudes, unsigned seed) {
  auto effect = std::make_shared<Effect>();
  effect->kind = "cable_spring";
  effect->steps = {1.0};
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Scored s;
  s.effect = effect;
  s.per_block = Eigen::MatrixXd(amplitudes, kBlocks);
  for (Eigen::Index i = 0; i < amplitudes; ++i)
    for (Eigen::Index b = 0; b < kBlocks; ++b) s.per_block(i, b) = normal(random);
  s.covariance = Eigen::MatrixXd::Identity(amplitudes, amplitudes) / static_cast<double>(kBlocks);
  return s;
}

double Flips(const std::vector<Scored>& scored, double rate, double more = 0.0) {
  return SignFlips(scored, rate, 1, more).flips;
}

TEST(SignFlips, GiveTheQuantileOfTheDropByChance) {
  // Of chi^2 with 20 degrees of freedom, less the penalty of one amplitude.
  const double expected = 31.41 - Penalty(*OfChance(1, 1).effect);
  double mean = 0.0;
  for (unsigned seed = 1; seed <= 8; ++seed) mean += Flips({OfChance(20, seed)}, 0.05) / 8.0;
  EXPECT_NEAR(mean, expected, 2.5);
}

TEST(SignFlips, AskMoreForFewerFalseAlarms) {
  const std::vector<Scored> scored = {OfChance(4, 3)};
  EXPECT_GT(Flips(scored, 0.01), Flips(scored, 0.05));
  // Beyond what was drawn, along a line.
  EXPECT_GT(Flips(scored, 1e-4), Flips(scored, 1e-3) + 2.0);
}

TEST(SignFlips, AskMoreOfTheBestOfMany) {
  std::vector<Scored> many;
  for (unsigned i = 0; i < 30; ++i) many.push_back(OfChance(10, 100 + i));
  EXPECT_GT(Flips(many, 0.05), Flips({many[0]}, 0.05) + 3.0);
}

TEST(SignFlips, AddWhatIsAsked) {
  const std::vector<Scored> scored = {OfChance(4, 3)};
  EXPECT_NEAR(Flips(scored, 0.05, 7.5), Flips(scored, 0.05) + 7.5, 1e-12);
  const ScoreThreshold t = SignFlips(scored, 0.01, 1, 7.5);
  EXPECT_EQ(t.rate, 0.01);
  EXPECT_GT(t.flips, t.calibrated) << "1 % is asked, 5 % calibrated";
}

TEST(SignFlips, AreTheSameForTheSameSeed) {
  const std::vector<Scored> scored = {OfChance(4, 3)};
  EXPECT_EQ(SignFlips(scored, 0.05, 5, 0.0).flips, SignFlips(scored, 0.05, 5, 0.0).flips);
  EXPECT_NE(SignFlips(scored, 0.05, 5, 0.0).flips, SignFlips(scored, 0.05, 6, 0.0).flips);
}

TEST(SignFlips, WhatScattersMoreThanNoiseCountsForLess) {
  Scored s = OfChance(20, 9);
  s.per_block *= 3.0;
  const double scattered = Flips({s}, 0.05);
  s.within_blocks = 9.0;
  EXPECT_LT(Flips({s}, 0.05), scattered / 5.0);
}

TEST(ScoreThreshold, ByChanceAloneHasNoAllowances) {
  const test::KnownAxis axis;
  const Effect& effect = *OfChance(1, 1).effect;
  ScoreThreshold t{.flips = 12.0, .calibrated = 12.0, .rate = 1e-3};
  t.leakage = 40.0;
  t.leakage_of_kind["cable_spring"] = 50.0;
  EXPECT_EQ(t.LeakageAs("cable_spring"), 90.0);
  EXPECT_EQ(t.LeakageAs("cogging"), 40.0);
  EXPECT_GT(Threshold(axis.problem, t, effect, {}), 102.0 - 1e-9);
  EXPECT_GT(Threshold(axis.problem, t), 52.0 - 1e-9);
  EXPECT_EQ(Threshold(axis.problem, ByChanceAlone(t), effect, {}), 12.0);
}

TEST(ScoreThreshold, OfANumberOfTheModelItsPriorSaysWhatIsChance) {
  const test::KnownAxis axis;
  Effect lag;
  lag.kind = "current_lag";
  lag.steps = {1e-6};
  ScoreThreshold rare{.flips = 500.0, .calibrated = 500.0, .rate = 1e-2},
      often{.flips = 500.0, .calibrated = 500.0, .rate = 0.5};
  EXPECT_LT(Threshold(axis.problem, rare, lag, {}), 20.0) << "sign flips say nothing about it";
  EXPECT_GT(Threshold(axis.problem, rare, lag, {}), Threshold(axis.problem, often, lag, {}));
  rare.accepted = 1;
  EXPECT_GE(Threshold(axis.problem, rare, lag, {}), 500.0) << "in addition to causes they do";
}

TEST(ScoreScale, OfACandidateIsItsScatter) {
  const test::KnownAxis axis;
  Scored s = OfChance(2, 5);
  s.overdispersion = 2.5;
  EXPECT_EQ(ScoreScaleOf(axis.problem, s).overdispersion, 2.5);
  EXPECT_EQ(ScoreScaleOf(axis.problem, s).variance_ratio, 1.0);
}

TEST(ScoreScale, OfANumberOfTheModelIsWhatTheLogLeavesOfItsVariance) {
  const test::KnownAxis axis;
  const std::size_t term = FreedTerms(axis.problem, "current_lag")[0];
  const double sigma = axis.problem.terms[term].sigma;
  auto lag = std::make_shared<Effect>();
  lag->kind = "current_lag";
  Scored s;
  s.effect = lag;
  s.covariance = Eigen::MatrixXd::Constant(1, 1, 0.04 * sigma * sigma);
  EXPECT_NEAR(ScoreScaleOf(axis.problem, s).variance_ratio, 0.04, 1e-12);
  // In a fit the base's own term has its prior on top of it.
  Fit fit;
  fit.point.base.assign(axis.problem.terms.size(), 0.0);
  fit.point.effects = {lag};
  fit.point.amplitudes = {{0.0}};
  const auto n = static_cast<Eigen::Index>(ParameterCount(fit.point));
  fit.covariance = Eigen::MatrixXd::Identity(n, n);
  fit.covariance(n - 1, n - 1) = 1.04 * sigma * sigma;
  EXPECT_NEAR(ScoreScaleOf(axis.problem, fit).variance_ratio, 0.04, 1e-12);
}

}  // namespace
}  // namespace contour::diagnosis
