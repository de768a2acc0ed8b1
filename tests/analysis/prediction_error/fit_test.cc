#include "analysis/prediction_error/fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "analysis/prediction_error/refit.h"
#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

test::HiddenOptions Options() {
  test::HiddenOptions o;
  o.seed = 11;
  o.duration_s = 20.0;
  o.parameter_spread = 0.0;
  o.scale = false;
  return o;
}

/// The stated model is the axis itself.
const test::LearntProblem& Made() {
  static const test::LearntProblem made(test::MakeHiddenAxis(Options()));
  return made;
}

std::size_t IndexOf(const std::string& name) {
  const auto& terms = Made().problem.terms;
  for (std::size_t i = 0; i < terms.size(); ++i)
    if (terms[i].name == name) return i;
  return terms.size();
}

TEST(Fit, FindsTheTruthFromAPointBesideIt) {
  Point start = Made().point;
  start.base[IndexOf("Fc")] = 0.1;
  start.base[IndexOf("s2")] = -0.1;
  const Fit fit = FitPoint(Made().problem, start);
  EXPECT_TRUE(fit.converged);
  for (const char* name : {"inertia", "Fc", "s2"}) {
    const std::size_t i = IndexOf(name);
    const auto k = static_cast<Eigen::Index>(i);
    EXPECT_LT(std::fabs(fit.point.base[i]), 5.0 * std::sqrt(fit.covariance(k, k)) + 0.005) << name;
    EXPECT_LT(std::sqrt(fit.covariance(k, k)), Made().problem.terms[i].sigma) << name;
  }
  EXPECT_LT(fit.cost, CostAt(Made().problem, start));
  EXPECT_NEAR(fit.cost, CostAt(Made().problem, fit.point), 1e-6 * fit.cost);
}

// At a minimum of |r|^2 and the priors the gradient is nothing in units of the parameters' own deviations.
TEST(Fit, EndsWhereTheGradientOfResidualAndPriorsVanishes) {
  const Fit fit = FitPoint(Made().problem, Made().point);
  Eigen::VectorXd gradient =
      fit.jacobian.transpose() *
      Eigen::Map<const Eigen::VectorXd>(fit.residual.data(), static_cast<Eigen::Index>(fit.residual.size()));
  for (std::size_t i = 0; i < fit.point.base.size(); ++i)
    gradient(static_cast<Eigen::Index>(i)) += fit.point.base[i] / std::pow(Made().problem.terms[i].sigma, 2);
  EXPECT_LT(gradient.dot(fit.covariance * gradient), 0.1);
}

TEST(Fit, SeveralFitsTogetherAreEachTheSameAsAlone) {
  Point far = Made().point;
  far.base[IndexOf("Fc")] = 0.2;
  const std::vector<Fit> both = FitPoints(Made().problem, {{Made().point, {}}, {far, {}}});
  ASSERT_EQ(both.size(), 2U);
  EXPECT_NEAR(both[0].cost, both[1].cost, 0.5);
  EXPECT_NEAR(both[1].cost, FitPoint(Made().problem, far).cost, 0.5);
}

// Of a larger model, that is: its last columns are for what the start does without.
TEST(Fit, SensitivitiesOfALargerModelServe) {
  auto effect = std::make_shared<Effect>();
  effect->steps = {1e-3};
  effect->apply = [](const std::vector<double>& a, AxisModel& m) { m.offset += a[0]; };
  Point larger = Made().point;
  larger.effects.push_back(effect);
  larger.amplitudes.push_back({0.0});
  const Fit known = FitPoint(Made().problem, larger);
  FitEffort held;
  held.most_refreshes = 0;
  held.covariance = false;
  Point start = Made().point;
  start.base[IndexOf("Fc")] = 0.02;
  const Fit fit = std::move(FitPoints(Made().problem, {{start, held, &known}})[0]);
  EXPECT_EQ(fit.jacobian.cols(), known.jacobian.cols() - 1);
  EXPECT_TRUE(fit.point.effects.empty());
  EXPECT_NEAR(fit.cost, FitPoint(Made().problem, start).cost, 0.5);
}

/// A constant torque with `f` of its amplitude, and how often a model with it was made.
std::shared_ptr<Effect> OffsetBy(double step, std::function<double(double)> f, int& made) {
  auto effect = std::make_shared<Effect>();
  effect->steps = {step};
  effect->apply = [f = std::move(f), &made](const std::vector<double>& a, AxisModel& m) {
    ++made;
    m.offset += f(a[0]);
  };
  return effect;
}

Fit FitOffset(std::shared_ptr<Effect> effect, Point start) {
  start.effects = {std::move(effect)};
  start.amplitudes = {{0.0}};
  return FitPoint(Made().problem, std::move(start));
}

// A cost that is rough over the length that sensitivities are taken over: each step keeps a tenth of what
// they promise, and new ones promise as much again.
TEST(Fit, NewSensitivitiesThatKeepNothingAreNotRenewed) {
  int made = 0;
  const Fit smooth = FitOffset(OffsetBy(
                                   1e-3, [](double a) { return a; }, made),
                               Made().point);
  const Eigen::Index last = smooth.covariance.rows() - 1;
  const double there = smooth.point.amplitudes[0][0], sd = std::sqrt(smooth.covariance(last, last));
  const double length = 10.0 * sd, slope = 0.04;
  const auto rough = [&](double a) {
    const double whole = length * std::round(a / length);
    return there - 2.0 * sd + whole + slope * (a - whole);
  };
  Point start = smooth.point;
  made = 0;
  const Fit fit = FitOffset(OffsetBy(length, rough, made), start);
  EXPECT_TRUE(fit.converged);
  const int columns = static_cast<int>(ParameterCount(fit.point));
  // Three sets of sensitivities, that of the end among them, and the steps between.
  EXPECT_LT(made, 5 * columns);
}

TEST(Fit, AmplitudesStayInsideTheirBounds) {
  auto effect = std::make_shared<Effect>();
  effect->steps = {1e-3};
  effect->low = {-0.01};
  effect->high = {0.02};
  effect->apply = [](const std::vector<double>& a, AxisModel& m) { m.offset += a[0]; };
  Point p = Made().point;
  p.effects.push_back(effect);
  p.amplitudes.push_back({0.0});
  ASSERT_EQ(ParameterCount(p), p.base.size() + 1);
  Eigen::VectorXd by = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(ParameterCount(p)));
  by(0) = 0.3;
  by(by.size() - 1) = 5.0;
  EXPECT_EQ(Moved(p, by).amplitudes[0][0], 0.02);
  EXPECT_EQ(Moved(p, -by).amplitudes[0][0], -0.01);
  EXPECT_NEAR(Moved(p, by).base[0], p.base[0] + 0.3, 1e-15);
}

}  // namespace
}  // namespace contour::diagnosis
