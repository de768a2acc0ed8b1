// What is said to be detectable is: on logs by code that shares nothing with the engine.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/decision/score_threshold.h"
#include "analysis/diagnosis/diagnose.h"
#include "tests/analysis/support/hidden_axis.h"
#include "tests/analysis/support/learnt_problem.h"

namespace contour::diagnosis {
namespace {

test::HiddenOptions Options(const std::vector<test::HiddenEffect>& effects) {
  test::HiddenOptions o;
  o.seed = 5;
  o.duration_s = 20.0;
  o.scale = o.temperature = o.axis2 = false;
  o.effects = effects;
  return o;
}

bool IsNamed(const Diagnosis& d, const std::string& kind) {
  return std::any_of(d.causes.begin(), d.causes.end(), [&](const Cause& c) {
    return c.kind == kind || std::find(c.indistinguishable_from.begin(), c.indistinguishable_from.end(),
                                       kind) != c.indistinguishable_from.end();
  });
}

TEST(SmallestDetectable, OnceAndAHalfIsFound) {
  const test::HiddenAxis clean = test::MakeHiddenAxis(Options({}));
  const Diagnosis d = Diagnose(clean.log, clean.stated);
  // A number of the model, of which the stated uncertainty decides, and what begins far from linear.
  const double delay_s = 1e-6 * d.smallest_detectable.at("input_delay").at("delay_us");
  const double share = d.smallest_detectable.at("presliding_hysteresis").at("share_rel");
  // A delay that chance makes of the stated uncertainty in one of a hundred is none to be found.
  EXPECT_GT(delay_s, 2.57 * clean.stated.sigma.at("delay") * clean.stated.delay_s);
  for (const test::HiddenEffect& e :
       {test::HiddenEffect{"input_delay", 1.5e3 * delay_s, 0.0, 0.0, 0.0},
        test::HiddenEffect{"presliding_hysteresis", 1.5 * share, 0.0, 0.0, 0.1}}) {
    const test::HiddenAxis axis = test::MakeHiddenAxis(Options({e}));
    EXPECT_TRUE(IsNamed(Diagnose(axis.log, axis.stated), e.kind)) << e.kind << " of " << e.size;
  }
}

SharedEffect Of(const Problem& problem, const std::string& kind) {
  for (SharedEffect& e : CatalogueEffects(problem))
    if (e->kind == kind) return e;
  return nullptr;
}

TEST(ScoreThreshold, ALeftOverMovesANumberOfTheModelByWhatTheLogDoesNotKnowOfIt) {
  const test::LearntProblem l(test::MakeHiddenAxis(Options({})));
  const SharedEffect delay = Of(l.problem, "input_delay");
  ASSERT_TRUE(delay);
  ScoreThreshold threshold;
  threshold.rate = 0.05;
  threshold.accepted = 1;
  threshold.leakage = 1000.0;
  const double known = Threshold(l.problem, threshold, *delay, {.variance_ratio = 0.0}),
               fairly = Threshold(l.problem, threshold, *delay, {.variance_ratio = 0.01}),
               unknown = Threshold(l.problem, threshold, *delay, {.variance_ratio = 1.0});
  EXPECT_LT(known, 7.0);  // chi^2 of one degree of freedom in 0.2 % less the penalty
  EXPECT_GT(fairly, known + 10.0);
  EXPECT_LT(fairly, known + 40.0);
  EXPECT_GT(unknown, 1000.0);
}

TEST(ScoreThreshold, WhatIsLeftOfAWaveIsMostlyFurtherOrdersOfIt) {
  const test::LearntProblem l(test::MakeHiddenAxis(Options({})));
  const SharedEffect drift = Of(l.problem, "friction_drift");
  ASSERT_TRUE(drift);
  ScoreThreshold threshold;
  threshold.rate = 0.05;
  threshold.accepted = 1;
  const double none = Threshold(l.problem, threshold, *drift, {});
  threshold.leakage_of_kind["cogging"] = 500.0;
  EXPECT_EQ(threshold.LeakageAs("cogging"), 500.0);
  EXPECT_EQ(Threshold(l.problem, threshold, *drift, {}), none);
  threshold.leakage = 60.0;
  EXPECT_NEAR(Threshold(l.problem, threshold, *drift, {}), none + 60.0, 1e-9);
  // Scores are over the overdispersion of chance; so is what is left.
  EXPECT_NEAR(Threshold(l.problem, threshold, *drift, {.overdispersion = 3.0}), none + 20.0, 1e-9);
}

TEST(ViscousNonlinear, WithAKneeGivesWay) {
  const test::LearntProblem l(test::MakeHiddenAxis(Options({})));
  int knees = 0;
  for (const SharedEffect& e : CatalogueEffects(l.problem)) {
    if (e->kind != "viscous_nonlinear" || e->order >= 1.0) continue;
    ++knees;
    EXPECT_EQ(e->low[0], 0.0) << e->label;
  }
  EXPECT_GT(knees, 0);
}

}  // namespace
}  // namespace contour::diagnosis
