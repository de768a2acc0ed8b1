#include "analysis/prediction_error/bootstrap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "analysis/diagnosis/diagnose.h"
#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

constexpr int kRuns = 60;

test::HiddenAxis Axis(const std::vector<test::HiddenEffect>& effects) {
  test::HiddenOptions o;
  o.seed = 11;
  o.duration_s = 20.0;
  o.scale = o.temperature = o.axis2 = false;
  o.effects = effects;
  return test::MakeHiddenAxis(o);
}
test::HiddenAxis CleanAxis() { return Axis({}); }
test::HiddenAxis AxisWithAWeight() { return Axis({{"constant_torque", 0.05, 0.0, 0.0, 0.0}}); }

Fit FittedBase(Problem& problem) {
  Point start;
  for (const BaseTerm& t : problem.terms) start.base.push_back(t.start);
  problem.LearnNoise(start);
  const Fit first = FitPoint(problem, start, {.most_steps = 4, .most_refreshes = 2});
  problem.LearnNoise(first.point);
  return FitPoint(problem, first.point, {.most_steps = 8, .most_refreshes = 2});
}

TEST(StrokeEnds, CoverTheLogAndFollowItsTurns) {
  const test::HiddenAxis axis = AxisWithAWeight();
  const Problem problem(axis.log, axis.stated, 1);
  const std::vector<std::size_t> ends = StrokeEnds(problem);
  ASSERT_GE(ends.size(), 20u);
  EXPECT_TRUE(std::is_sorted(ends.begin(), ends.end()));
  EXPECT_EQ(ends.back(), problem.rows());
  // Where the axis turns after a long stroke, there is an end.
  const std::vector<double>& q = problem.signals->position;
  const auto highest = static_cast<std::ptrdiff_t>(std::max_element(q.begin(), q.end()) - q.begin());
  std::ptrdiff_t nearest = highest;
  for (const std::size_t end : ends)
    nearest = std::min(nearest, std::abs(static_cast<std::ptrdiff_t>(end) - highest));
  EXPECT_LT(nearest, 100);
}

// Mean over the parameters, on a logarithmic scale: scatter of the draws over the fit's standard deviation.
double ScatterOverCovariance(const test::HiddenAxis& axis) {
  Problem problem(axis.log, axis.stated, 1);
  const Fit fit = FittedBase(problem);
  const Eigen::MatrixXd draws = StrokeBootstrap(problem, fit, kRuns, 1);
  const Eigen::MatrixXd about = draws.colwise() - draws.rowwise().mean();
  double sum = 0.0;
  for (Eigen::Index i = 0; i < about.rows(); ++i) {
    const double sd = about.row(i).norm() / std::sqrt(kRuns - 1.0);
    const double ratio = sd / std::sqrt(fit.covariance(i, i));
    EXPECT_GE(ratio, 0.999) << problem.terms[static_cast<std::size_t>(i)].name;
    sum += std::log(ratio);
  }
  return std::exp(sum / static_cast<double>(about.rows()));
}

TEST(StrokeBootstrap, AgreesWithTheCovarianceUnderEvenNoise) {
  EXPECT_LT(ScatterOverCovariance(CleanAxis()), 1.35);
}

// What has one sign along each stroke is larger in the sum than its rows are: only strokes show it.
TEST(StrokeBootstrap, WhatDisturbsAWholeStrokeWidensTheIntervals) {
  test::HiddenAxis axis = CleanAxis();
  const Problem problem(axis.log, axis.stated, 1);
  std::mt19937_64 random(3);
  std::size_t from = 0;
  for (const std::size_t end : StrokeEnds(problem)) {
    const double by = (random() & 1U) != 0 ? 0.004 : -0.004;
    for (std::size_t k = from; k < end; ++k) axis.log.command[k] += by;
    from = end;
  }
  EXPECT_GT(ScatterOverCovariance(axis), 1.5 * ScatterOverCovariance(CleanAxis()));
}

TEST(StrokeBootstrap, GivesIntervalsThatThreadsDoNotChange) {
  const test::HiddenAxis axis = AxisWithAWeight();
  DiagnoseOptions one, two, plain;
  one.bootstrap_runs = two.bootstrap_runs = kRuns;
  two.threads = 2;
  const Diagnosis a = Diagnose(axis.log, axis.stated, one), b = Diagnose(axis.log, axis.stated, two);
  ASSERT_FALSE(a.causes.empty());
  ASSERT_EQ(a.causes.size(), b.causes.size());
  EXPECT_EQ(a.bootstrap_runs, kRuns);
  const Interval x = a.causes[0].parameters.at("torque_Nm"), y = b.causes[0].parameters.at("torque_Nm");
  EXPECT_EQ(x.low, y.low);
  EXPECT_EQ(x.high, y.high);
  EXPECT_LT(x.low, x.value);
  EXPECT_LT(x.value, x.high);
  const Diagnosis without = Diagnose(axis.log, axis.stated, plain);
  EXPECT_EQ(without.causes[0].parameters.at("torque_Nm").value, x.value);
  EXPECT_NE(without.causes[0].parameters.at("torque_Nm").low, x.low);
}

}  // namespace
}  // namespace contour::diagnosis
