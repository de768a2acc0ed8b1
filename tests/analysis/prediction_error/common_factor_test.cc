#include "analysis/prediction_error/common_factor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/prediction_error/fit.h"
#include "tests/analysis/support/distance.h"
#include "tests/analysis/support/hidden_axis.h"
#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

test::HiddenAxis Made(bool two_inertia) {
  test::HiddenOptions o;
  o.seed = 11;
  o.duration_s = 10.0;
  o.two_inertia = two_inertia;
  test::HiddenAxis a = test::MakeHiddenAxis(o);
  a.stated.sigma["torque_constant"] = 0.02;
  return a;
}

bool IsForce(const BaseTerm& t) { return !t.additive && t.name != "vs" && t.name != "torque_constant"; }

Point TimesAllForces(const Problem& problem, Point p, double factor) {
  for (std::size_t i = 0; i < p.base.size(); ++i)
    if (IsForce(problem.terms[i]) || problem.terms[i].name == "torque_constant")
      p.base[i] += std::log(factor);
  for (std::size_t e = 0; e < p.effects.size(); ++e)
    for (std::size_t i = 0; i < p.effects[e]->force.size(); ++i)
      p.amplitudes[e][i] *= std::pow(factor, p.effects[e]->force[i]);
  return p;
}

class EveryEffect : public testing::TestWithParam<bool> {};

TEST_P(EveryEffect, TellsWhichOfItsAmplitudesAreForces) {
  const test::LearntProblem l(Made(GetParam()));
  for (const SharedEffect& e : CatalogueEffects(l.problem)) {
    if (e->kind == "torque_constant") continue;  // is the factor itself
    // Impacts in the gap make much of a last bit.
    if (e->kind == "backlash") continue;
    Point with = l.point;
    with.effects = {e};
    with.amplitudes = {e->start.empty() ? e->steps : e->start};
    if (e->start.empty())
      for (double& a : with.amplitudes[0]) a *= 3.0;
    const std::vector<Point> points = {l.point, with, TimesAllForces(l.problem, with, 1.1)};
    const std::vector<std::vector<double>> raw = l.problem.Raw(points);
    EXPECT_LT(test::Distance(raw[1], raw[2]), 1e-5 * test::Distance(raw[0], raw[1]))
        << e->kind << " " << e->label;
  }
}

INSTANTIATE_TEST_SUITE_P(Axes, EveryEffect, testing::Bool(),
                         [](const auto& two) { return std::string(two.param ? "two_inertias" : "rigid"); });

// Differences of runs alone leave some 1e-3 in that direction, which the priors do not stand up to.
TEST(CommonFactor, OfAllForcesAndTheTorqueConstantMovesNoResidual) {
  const test::LearntProblem l(Made(true));
  const Fit fit = FitPoint(l.problem, l.point, {.most_steps = 2, .most_refreshes = 1});
  Eigen::VectorXd all = Eigen::VectorXd::Zero(fit.jacobian.rows());
  double size = 0.0;
  for (std::size_t i = 0; i < l.problem.terms.size(); ++i) {
    const BaseTerm& t = l.problem.terms[i];
    if (!IsForce(t) && t.name != "torque_constant") continue;
    const auto column = fit.jacobian.col(static_cast<Eigen::Index>(i));
    all += column;
    size = std::max(size, column.norm());
  }
  EXPECT_LT(all.norm(), 1e-12 * size);
}

// Within what is stated of it the fit moves the constant itself, too: that is no force that stays.
TEST(CommonFactor, WhatTheStatedConstantWasMovedByIsPartOfIt) {
  const test::LearntProblem l(Made(false));
  Point off = l.point;
  off.base.assign(off.base.size(), 0.0);
  for (std::size_t i = 0; i < off.base.size(); ++i) {
    if (l.problem.terms[i].nuisance) continue;
    if (l.problem.terms[i].name == "torque_constant") off.base[i] = -0.03;
    if (IsForce(l.problem.terms[i])) off.base[i] = 0.1;
  }
  const CommonFactor factor = FindCommonFactor(l.problem, off);
  EXPECT_NEAR(factor.log_ratio, -0.13, 1e-12);
  EXPECT_NEAR(factor.drop, PriorOf(l.problem, off), 1e-9);
  Point taken = off;
  TakeOver(l.problem, factor.log_ratio, taken);
  EXPECT_NEAR(PriorOf(l.problem, taken), 0.0, 1e-9);
  const std::vector<SharedEffect> all = CatalogueEffects(l.problem);
  taken.effects = {
      *std::find_if(all.begin(), all.end(), [](const auto& e) { return e->kind == "torque_constant"; })};
  taken.amplitudes = {{std::expm1(factor.log_ratio)}};
  const std::vector<Point> points = {l.point, off, taken};
  const std::vector<std::vector<double>> raw = l.problem.Raw(points);
  EXPECT_LT(test::Distance(raw[1], raw[2]), 1e-5 * test::Distance(raw[0], raw[1]));
}

}  // namespace
}  // namespace contour::diagnosis
