#include "analysis/prediction_error/problem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

test::HiddenOptions Short() {
  test::HiddenOptions o;
  o.duration_s = 10.0;
  return o;
}

std::size_t IndexOf(const Problem& problem, const std::string& name) {
  for (std::size_t i = 0; i < problem.terms.size(); ++i)
    if (problem.terms[i].name == name) return i;
  ADD_FAILURE() << name;
  return 0;
}

Point Zero(const Problem& problem) {
  Point p;
  p.base.assign(problem.terms.size(), 0.0);
  return p;
}

TEST(Problem, TermsAreFactorsOfStatedNumbersWithTheirStatedSigma) {
  test::HiddenAxis axis = test::MakeHiddenAxis(Short());
  axis.stated.sigma["Fc"] = 0.07;
  axis.stated.sigma.erase("s0");
  const Problem problem(axis.log, axis.stated, 1);
  const std::size_t fc = IndexOf(problem, "Fc");
  EXPECT_EQ(problem.terms[fc].sigma, 0.07);
  EXPECT_EQ(StatedSigma(axis.stated, "s0"), 0.20);
  Point p = Zero(problem);
  p.base[fc] = std::log(1.5);
  const AxisModel m = problem.Build(p);
  // Both directions, and nothing else.
  EXPECT_NEAR(m.friction.Fc_plus / axis.stated.friction.Fc_plus, 1.5, 1e-12);
  EXPECT_NEAR(m.friction.Fc_minus / axis.stated.friction.Fc_minus, 1.5, 1e-12);
  EXPECT_EQ(m.friction.Fs_plus, axis.stated.friction.Fs_plus);
  EXPECT_EQ(m.motor_inertia, axis.stated.motor_inertia);
}

TEST(Problem, WhatWasLearntOfTheNoiseIsThereAgainWithoutLearning) {
  const test::LearntProblem made(test::MakeHiddenAxis(Short()));
  Problem problem = made.problem;
  const LearntNoise kept = problem.Learnt();
  const double log_noise = problem.LogNoise();
  const std::vector<double> white = problem.Residuals(std::span(&made.point, 1))[0];
  Point off = made.point;
  off.base[IndexOf(problem, "Fc")] += 0.3;
  problem.LearnNoise(off);
  EXPECT_NE(problem.LogNoise(), log_noise);
  problem.Take(kept);
  EXPECT_EQ(problem.LogNoise(), log_noise);
  EXPECT_EQ(problem.Residuals(std::span(&made.point, 1))[0], white);
}

TEST(Problem, WithoutAStribeckDropBothLevelsGoTogether) {
  test::HiddenAxis axis = test::MakeHiddenAxis(Short());
  axis.stated.friction.Fs_plus = axis.stated.friction.Fc_plus;
  axis.stated.friction.Fs_minus = axis.stated.friction.Fc_minus;
  const Problem problem(axis.log, axis.stated, 1);
  Point p = Zero(problem);
  p.base[IndexOf(problem, "Fc")] = 0.2;
  const AxisModel m = problem.Build(p);
  EXPECT_DOUBLE_EQ(m.friction.Fs_plus, m.friction.Fc_plus);
}

TEST(Problem, DelayAndLagAreAddedTo) {
  const test::HiddenAxis axis = test::MakeHiddenAxis(Short());
  const Problem problem(axis.log, axis.stated, 1);
  Point p = Zero(problem);
  p.base[IndexOf(problem, "delay")] = 3e-5;
  EXPECT_NEAR(problem.Build(p).delay_s, axis.stated.delay_s + 3e-5, 1e-15);
}

TEST(Problem, RowsAfterAMissingOneAndAtTheBeginningDoNotCount) {
  test::HiddenAxis axis = test::MakeHiddenAxis(Short());
  axis.log.position[5000] = std::nan("");
  axis.log.present[5000] = 0;
  const Problem problem(axis.log, axis.stated, 1);
  EXPECT_EQ(problem.counted[299], 0);
  EXPECT_EQ(problem.counted[300], 1);
  for (std::size_t k = 4998; k < 5003; ++k) EXPECT_EQ(problem.counted[k], 0) << k;
  EXPECT_EQ(problem.counted[5003], 1);
}

TEST(Problem, AnEffectEntersTheModelAndItsResidual) {
  const test::LearntProblem made(test::MakeHiddenAxis(Short()));
  auto effect = std::make_shared<Effect>();
  effect->kind = "constant";
  effect->steps = {1e-3};
  effect->apply = [](const std::vector<double>& a, AxisModel& m) { m.offset += a[0]; };
  Point with = made.point;
  with.effects.push_back(effect);
  with.amplitudes.push_back({0.02});
  EXPECT_NEAR(made.problem.Build(with).offset, 0.02, 1e-15);
  const Point both[] = {made.point, with};
  const auto white = made.problem.Residuals(both);
  const auto squares = [](const std::vector<double>& r) {
    return std::inner_product(r.begin(), r.end(), r.begin(), 0.0);
  };
  EXPECT_GT(squares(white[1]), 1.5 * squares(white[0]));
}

TEST(Problem, WhatTheStatedModelHasBeyondItsNumbersIsWorthItsSquares) {
  test::HiddenAxis axis = test::MakeHiddenAxis(Short());
  {
    const test::LearntProblem made(axis);
    EXPECT_EQ(made.problem.ExplainedByExtras(made.point), 0.0);
  }
  axis.stated.extras.cogging = {{0.05 * axis.stated.rated, 4.0, 0.0}};
  const test::LearntProblem made(axis);
  // There is no cogging in the axis: without it the residual is smaller.
  EXPECT_LT(made.problem.ExplainedByExtras(made.point), -100.0);
}

TEST(Problem, ResponsesToSignalsAreDifferencesOfResiduals) {
  const test::LearntProblem made(test::MakeHiddenAxis(Short()));
  auto force = std::make_shared<Effect>();
  force->kind = "force";
  force->steps = {1e-5};
  force->tested = 1;
  const std::size_t rows = made.problem.rows();
  force->apply = [rows](const std::vector<double>& a, AxisModel& m) {
    Signal s(rows);
    for (std::size_t k = 0; k < rows; ++k) s[k] = a[0] * std::sin(0.01 * static_cast<double>(k));
    m.motor_force = std::make_shared<const Signal>(std::move(s));
  };
  const SharedEffect effects[] = {force};
  const auto column = made.problem.LinearResponses(made.point, effects)[0];
  Point with = made.point;
  with.effects.push_back(force);
  with.amplitudes.push_back({1e-5});
  const Point both[] = {made.point, with};
  const auto white = made.problem.Residuals(both);
  double product = 0.0, own = 0.0, other = 0.0;
  for (std::size_t k = 0; k < column.size(); ++k) {
    const double difference = (white[1][k] - white[0][k]) / 1e-5;
    product += column[k] * difference;
    own += column[k] * column[k];
    other += difference * difference;
  }
  EXPECT_GT(product / std::sqrt(own * other), 0.99);
  EXPECT_NEAR(std::sqrt(own / other), 1.0, 0.05);
}

}  // namespace
}  // namespace contour::diagnosis
