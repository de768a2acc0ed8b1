#include "analysis/diagnosis/screening/score.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

TEST(Score, APenaltyIsOfEveryAmplitudeAndOfThePlacesThatWereLookedAt) {
  Effect one, two, many;
  one.steps = {0.1};
  two.steps = {0.1, 0.1};
  many.steps = {0.1};
  many.grid = 20.0;
  EXPECT_GT(Penalty(one), 1.0) << "noise lowers chi^2 by one";
  EXPECT_NEAR(Penalty(two), 2.0 * Penalty(one), 1e-12);
  EXPECT_NEAR(Penalty(many) - Penalty(one), 2.0 * std::log(20.0), 1e-12);
  many.grid = 0.5;
  EXPECT_EQ(Penalty(many), Penalty(one)) << "less than one place was never looked at";
}

// Before: of a cable off the middle of the stroke 16 rows, where the axis hardly broke away, had all but a
// thousandth of a column's square, and the score test saw nothing of 16000 nats.
TEST(Score, RowsThatRunAwaySayNothingAndTheOthersStay) {
  std::vector<double> column(3000);
  for (std::size_t k = 0; k < column.size(); ++k) column[k] = std::sin(0.1 * static_cast<double>(k));
  std::vector<double> with = column;
  LeaveOutRunaways(with, with.size());
  EXPECT_EQ(with, column) << "none runs away";
  double runaway = 1.0;
  for (std::size_t k = 1000; k < 1020; ++k) with[k] = runaway *= 3.0;
  LeaveOutRunaways(with, with.size());
  for (std::size_t k = 1010; k < 1020; ++k) EXPECT_EQ(with[k], 0.0) << k;
  with.erase(with.begin() + 1000, with.begin() + 1020);
  column.erase(column.begin() + 1000, column.begin() + 1020);
  EXPECT_EQ(with, column);
  std::vector<double> nothing(100, 0.0);
  LeaveOutRunaways(nothing, nothing.size());
  EXPECT_EQ(nothing, std::vector<double>(100, 0.0));
}

// Two waves, of which the base nearly does the first: a millionth of its information is left, and a gradient
// that a fit short of its end left there. Before: the score of a pitch error beside an eccentricity was 35
// times what it explains alone, and neither was told as what the log cannot tell from the other.
TEST(Score, OfWhatTheBaseNearlyDoesOnlyTheRestCounts) {
  Eigen::MatrixXd square(2, 2), information(2, 2);
  square << 4.0, 0.4, 0.4, 9.0;
  const Eigen::MatrixXd all = square.llt().matrixL();
  information = all * Eigen::Vector2d(1e-6, 0.8).asDiagonal() * all.transpose();
  const Eigen::Vector2d along_base = all * Eigen::Vector2d(0.3, 0.0), rest = all * Eigen::Vector2d(0.0, 5.0);
  EXPECT_NEAR(DropAlongBase(information, square, along_base), 0.09 / 1e-6, 1.0);
  EXPECT_NEAR(DropAlongBase(information, square, along_base + rest), 0.09 / 1e-6, 1.0);
  EXPECT_NEAR(DropAlongBase(information, square, rest), 0.0, 1e-3);
  EXPECT_EQ(DropAlongBase(square, square, along_base + rest), 0.0);
}

// A place where the response grows for more than a block's length, of two outputs, over what is everywhere.
TEST(Score, APlaceThatRunsAwayForLongIsLeftOutOfEveryOutput) {
  const std::size_t rows = 3000;
  std::vector<double> column(2 * rows);
  for (std::size_t k = 0; k < column.size(); ++k) column[k] = std::sin(0.1 * static_cast<double>(k));
  std::vector<double> with = column;
  for (std::size_t k = 1010; k < 1090; ++k)
    with[k] = with[rows + k] = 10.0 * std::exp(0.5 * static_cast<double>(k - 1010));
  LeaveOutRunaways(with, rows);
  for (std::size_t k = 0; k < rows; ++k) {
    const bool runs_away = k >= 1010 && k < 1090;
    EXPECT_EQ(with[k], runs_away ? 0.0 : column[k]) << k;
    EXPECT_EQ(with[rows + k], runs_away ? 0.0 : column[rows + k]) << k;
  }
}

// Before: the bound fell with what it left out, and of what decays exponentially nothing was left.
TEST(Score, ShortResponsesAtAFewReversalsStay) {
  const std::size_t rows = 24000;
  for (const std::size_t reversals : {4u, 10u, 20u})
    for (const double tau : {0.2, 1.0, 3.0, 10.0, 20.0}) {
      std::vector<double> column(rows, 0.0);
      for (std::size_t i = 0; i < reversals; ++i)
        for (std::size_t k = 0; k < 800; ++k)
          column[i * rows / reversals + 100 + k] += std::exp(-static_cast<double>(k) / tau);
      std::vector<double> with = column;
      LeaveOutRunaways(with, rows);
      EXPECT_EQ(with, column) << reversals << " reversals of " << tau << " rows";
    }
}

TEST(Score, WhatActsNowhereElseStays) {
  std::vector<double> column(3000, 0.0);
  column[1000] = 1.0;
  std::vector<double> with = column;
  LeaveOutRunaways(with, with.size());
  EXPECT_EQ(with, column);
}

class ScoreTest : public testing::Test {
 protected:
  Scored ScoreOf(const Fit& fit, const SharedEffect& effect) const {
    return ScoreEffects(axis_.problem, fit, {effect})[0];
  }
  /// The base fit, and in its residual what an effect of that amplitude would put there.
  Fit Without(double amplitude, const Eigen::VectorXd& column) const {
    Fit fit = axis_.base;
    for (std::size_t k = 0; k < fit.residual.size(); ++k)
      fit.residual[k] -= amplitude * column(static_cast<Eigen::Index>(k));
    return fit;
  }

  /// White, of an effect that is a signal: it does not depend on a residual.
  Eigen::VectorXd ColumnOf(const SharedEffect& effect) const {
    const std::vector<double> column =
        axis_.problem.LinearResponses(axis_.base.point, std::span(&effect, 1))[0];
    return Eigen::Map<const Eigen::VectorXd>(column.data(), static_cast<Eigen::Index>(column.size()));
  }

  test::FittedAxis axis_;
};

TEST_F(ScoreTest, FreedTermsAreThoseThatTheModelHas) {
  ASSERT_EQ(FreedTerms(axis_.problem, "current_lag").size(), 1u);
  EXPECT_EQ(axis_.problem.terms[FreedTerms(axis_.problem, "current_lag")[0]].name, "lag");
  EXPECT_TRUE(FreedTerms(axis_.problem, "compliance").empty()) << "a rigid model states no stiffness";
  EXPECT_TRUE(InBase(axis_.problem, "stribeck"));
  EXPECT_TRUE(InBase(axis_.problem, "torque_constant"));
  EXPECT_FALSE(InBase(axis_.problem, "compliance"));
  EXPECT_FALSE(InBase(axis_.problem, "cogging"));
}

TEST_F(ScoreTest, TheAmplitudeIsWhatIsMissing) {
  const SharedEffect e = axis_.Of("cable_spring")->shorter;
  const Eigen::VectorXd column = ColumnOf(e);
  // What the base makes up for is no longer there once it is fitted.
  const Eigen::MatrixXd& base = axis_.base.jacobian;
  const Eigen::VectorXd rest = column - base * (axis_.base.covariance * (base.transpose() * column));
  const Scored before = ScoreOf(axis_.base, e);
  const double sigma = std::sqrt(before.covariance(0, 0)), amplitude = 20.0 * sigma;
  EXPECT_NEAR(column.dot(rest) * sigma * sigma, 1.0, 1e-3);
  const Scored after = ScoreOf(Without(amplitude, rest), e);
  EXPECT_NEAR(after.amplitude(0) - before.amplitude(0), amplitude, 0.02 * amplitude);
  // 20 standard errors: 400 of chi^2.
  const double expected = std::pow((before.amplitude(0) + amplitude) / sigma, 2);
  EXPECT_NEAR(after.drop, expected, 0.02 * expected);
  EXPECT_NEAR(after.score, after.drop / after.within_blocks - Penalty(*e), 1e-9);
}

TEST_F(ScoreTest, WhatIsThereAllTheTimeIsConsistentAndOneEventIsNot) {
  const SharedEffect e = axis_.Of("cable_spring")->shorter;
  const Eigen::VectorXd column = ColumnOf(e);
  const double sigma = std::sqrt(ScoreOf(axis_.base, e).covariance(0, 0));
  const Scored all = ScoreOf(Without(30.0 * sigma, column), e);
  Eigen::VectorXd event = Eigen::VectorXd::Zero(column.size());
  const Eigen::Index block = column.size() / kBlocks;
  event.segment(20 * block, block) = column.segment(20 * block, block);
  const Scored once = ScoreOf(Without(300.0 * sigma, event), e);
  EXPECT_GT(all.consistency, 2.0 * once.consistency);
  EXPECT_GT(once.within_blocks, 2.0 * all.within_blocks);
}

TEST_F(ScoreTest, WhatWandersForLongerThanABlockScattersMore) {
  // Of a scale, say: the same amplitude for six blocks, and the other sign for the next six.
  const SharedEffect e = axis_.Of("cable_spring")->shorter;
  const Eigen::VectorXd column = ColumnOf(e);
  const double sigma = std::sqrt(ScoreOf(axis_.base, e).covariance(0, 0));
  const Eigen::Index together = 6 * column.size() / kBlocks;
  Eigen::VectorXd wander = column;
  for (Eigen::Index k = 0; k < wander.size(); ++k) wander(k) *= k / together % 2 == 0 ? 1.0 : -1.0;
  const Scored s = ScoreOf(Without(30.0 * sigma, wander), e);
  EXPECT_GT(s.overdispersion, 1.2 * s.within_blocks);
  EXPECT_LT(s.drop / s.overdispersion, 40.0) << "900 of chi^2, had it been there all the time";
}

TEST_F(ScoreTest, ColumnsOfSignalsAreThoseOfRuns) {
  const test::FittedAxis pushed({{"cable_spring", 0.2, 0.0, 0.0, 0.0}});
  const SharedEffect spring = pushed.Of("cable_spring")->shorter;
  ASSERT_TRUE(spring->signals);
  auto by_runs = std::make_shared<Effect>(*spring);
  by_runs->signals = false;
  const Scored linear = ScoreEffects(pushed.problem, pushed.base, {spring})[0],
               runs = ScoreEffects(pushed.problem, pushed.base, {by_runs})[0];
  EXPECT_GT(linear.drop, 100.0);
  EXPECT_NEAR(linear.amplitude(0), runs.amplitude(0), 0.1 * std::fabs(runs.amplitude(0)));
  EXPECT_NEAR(linear.drop, runs.drop, 0.15 * runs.drop);
}

TEST_F(ScoreTest, ColumnsOfABaseTermAreThoseOfRuns) {
  const test::FittedAxis loaded({{"payload_step", 0.2, 0.0, 0.0, 0.5}});
  SharedEffect step;
  for (const SharedEffect& e : CatalogueEffects(loaded.problem))
    if (e->kind == "payload_step" && e->from_row == loaded.problem.rows() / 2) step = e;
  ASSERT_TRUE(step);
  auto by_runs = std::make_shared<Effect>(*step);
  by_runs->as_term.clear();
  const Scored term = ScoreEffects(loaded.problem, loaded.base, {step})[0],
               runs = ScoreEffects(loaded.problem, loaded.base, {by_runs})[0];
  EXPECT_GT(term.drop, 50.0);
  EXPECT_NEAR(term.amplitude(0), runs.amplitude(0), 0.05 * std::fabs(runs.amplitude(0)));
  EXPECT_NEAR(term.drop, runs.drop, 0.1 * runs.drop);
}

TEST_F(ScoreTest, OfANumberOfTheModelThePriorTells) {
  const SharedEffect e = axis_.Of("input_delay");
  const std::size_t term = FreedTerms(axis_.problem, "input_delay")[0];
  Fit fit = axis_.base;
  const double sigma = axis_.problem.terms[term].sigma;
  fit.point.base[term] = 4.0 * sigma;
  // As good as known by the log: 16 of the prior, of which nothing else knows.
  fit.covariance.setZero();
  fit.covariance(static_cast<Eigen::Index>(term), static_cast<Eigen::Index>(term)) = 1e-6 * sigma * sigma;
  EXPECT_NEAR(ScoreOf(fit, e).drop, 16.0, 0.01);
  EXPECT_EQ(ScoreOf(fit, e).overdispersion, 1.0);
  // Not known at all, it stays at the most a tenth is known.
  fit.point.base[term] = 0.0;
  EXPECT_NEAR(ScoreOf(fit, e).drop, 0.0, 1e-9);
}

// Before: of a column that the base nearly does, such as an inertia that changes early in the log, a tenth of
// chi^2 that a fit had not gone for made thousands; the right instant, and its size, were not looked at.
TEST_F(ScoreTest, WhatTheBaseHasNotGoneDownYetIsNoEvidence) {
  SharedEffect step;
  for (const SharedEffect& e : CatalogueEffects(axis_.problem))
    if (e->kind == "payload_step" && e->from_row == axis_.problem.rows() / 2) step = e;
  ASSERT_TRUE(step);
  std::size_t inertia = 0;
  while (axis_.problem.terms[inertia].name != "inertia") ++inertia;
  const auto column = static_cast<Eigen::Index>(inertia);
  const double short_by = 10.0 * std::sqrt(axis_.base.covariance(column, column));
  Fit fit = axis_.base;
  fit.point.base[inertia] += short_by;
  for (std::size_t k = 0; k < fit.residual.size(); ++k)
    fit.residual[k] += short_by * fit.jacobian(static_cast<Eigen::Index>(k), column);
  const double drop = ScoreOf(axis_.base, step).drop;
  EXPECT_NEAR(ScoreOf(fit, step).drop, drop, 0.05 * drop + 0.1);
}

TEST_F(ScoreTest, AShorterHypothesisIsTestedAtNoCost) {
  const SharedEffect e = axis_.Of("cable_spring");
  const std::vector<Scored> scored = ScoreEffects(axis_.problem, axis_.base, {e});
  ASSERT_EQ(scored.size(), 2u);
  EXPECT_EQ(scored[0].amplitude.size(), 4);
  EXPECT_EQ(scored[1].amplitude.size(), 1);
  EXPECT_LE(scored[1].drop, scored[0].drop + 1e-6) << "it has one of the other's amplitudes";
}

TEST_F(ScoreTest, TheFittedEffectsOwnResidualScattersAsWhiteNoise) {
  const Fit fit = axis_.With(axis_.Of("constant_torque"));
  EXPECT_GE(OverdispersionOfLast(axis_.problem, fit), 1.0);
  EXPECT_LT(OverdispersionOfLast(axis_.problem, fit), 2.5);
  // Plus in one block and minus in the next: it explains nothing, and scatters as nothing white does.
  Fit scattered = fit;
  const Eigen::VectorXd column = fit.jacobian.rightCols(1);
  const Eigen::Index block = column.size() / kBlocks;
  const double amplitude = 100.0 / column.norm();
  for (Eigen::Index k = 0; k < column.size(); ++k)
    scattered.residual[static_cast<std::size_t>(k)] +=
        (k / block % 2 == 0 ? amplitude : -amplitude) * column(k);
  EXPECT_GT(OverdispersionOfLast(axis_.problem, scattered), 20.0);
  EXPECT_EQ(OverdispersionOfLast(axis_.problem, axis_.With(axis_.Of("input_delay"))), 1.0);
}

}  // namespace
}  // namespace contour::diagnosis
