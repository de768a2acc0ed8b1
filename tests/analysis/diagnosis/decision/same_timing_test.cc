#include "analysis/diagnosis/decision/same_timing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "tests/analysis/support/known_axis.h"

namespace contour::diagnosis {
namespace {

/// Made up: what fits would say, and no more of them than is asked.
class SameTimingTest : public testing::Test {
 protected:
  static Hypothesis Of(const test::KnownAxis& axis, const std::string& kind, double score) {
    Hypothesis h;
    h.fit.point.base.assign(axis.problem.terms.size(), 0.0);
    std::vector<SharedEffect> grid;
    (*CauseNamed(kind).grid)(axis.problem, grid);
    const SharedEffect& effect = grid[0];
    h.fit.point.effects = {effect};
    h.fit.point.amplitudes = {effect->start.empty() ? std::vector<double>(effect->steps.size(), 0.0)
                                                    : effect->start};
    const auto columns = static_cast<Eigen::Index>(axis.problem.terms.size() + effect->steps.size());
    h.fit.covariance = Eigen::MatrixXd::Zero(columns, columns);
    h.score = score;
    return h;
  }

  /// So much lag in exchange for delay, held by its prior to a part of what the log would have.
  void Exchange(Hypothesis& h, double lag_s, double part) {
    const auto& terms = axis_.problem.terms;
    const auto term =
        std::find_if(terms.begin(), terms.end(), [](const BaseTerm& t) { return t.name == "lag_for_delay"; });
    ASSERT_NE(term, terms.end());
    const auto at = term - terms.begin();
    h.fit.point.base[static_cast<std::size_t>(at)] = part * lag_s;
    h.fit.covariance(at, at) = (1.0 - part) * term->sigma * term->sigma;
    gained_ = part * lag_s * lag_s / (term->sigma * term->sigma);
  }

  const test::KnownAxis axis_;  // stated as rigid, 1 kHz, a delay of 1 ms
  double gained_ = 0.0;
};

TEST_F(SameTimingTest, ADelayMayDoWhatALagDoesWhereACouplingIsNotHeldAgainstIt) {
  const Hypothesis lag = Of(axis_, "current_lag", 100.0);
  Hypothesis delay = Of(axis_, "input_delay", 30.0);
  EXPECT_FALSE(SameTiming(axis_.problem, lag, delay, 12.0));
  Exchange(delay, 100e-6, 0.25);
  ASSERT_GT(gained_, 0.0);
  delay.score = 100.0 - 12.0 - gained_ + 0.1;
  EXPECT_TRUE(SameTiming(axis_.problem, lag, delay, 12.0));
  delay.score -= 0.2;
  EXPECT_FALSE(SameTiming(axis_.problem, lag, delay, 12.0));
}

TEST_F(SameTimingTest, WhatBothPayForPartsThem) {
  Hypothesis lag = Of(axis_, "current_lag", 100.0), delay = Of(axis_, "input_delay", 0.0);
  Exchange(lag, 100e-6, 0.25);
  Exchange(delay, 100e-6, 0.25);
  delay.score = 100.0 - 12.0 - 0.1;
  EXPECT_FALSE(SameTiming(axis_.problem, lag, delay, 12.0));
  delay.score += 0.2;
  EXPECT_TRUE(SameTiming(axis_.problem, lag, delay, 12.0));
}

TEST_F(SameTimingTest, NoCouplingThatTheRowsShowOrThatLeadsIsMeant) {
  const Hypothesis lag = Of(axis_, "current_lag", 100.0);
  Hypothesis delay = Of(axis_, "input_delay", 87.0);
  // An antiresonance of 500 Hz: the root of 0.2^2 + 2 / (2 pi 0.5)^2 ms^2 less 0.2 ms.
  Exchange(delay, 290e-6, 0.25);
  EXPECT_TRUE(SameTiming(axis_.problem, lag, delay, 12.0));
  Exchange(delay, 295e-6, 0.25);
  EXPECT_FALSE(SameTiming(axis_.problem, lag, delay, 12.0));
  Exchange(delay, -100e-6, 0.25);
  EXPECT_FALSE(SameTiming(axis_.problem, lag, delay, 12.0));
}

TEST_F(SameTimingTest, OnlyATimeAndACouplingOfARigidAxisAreAlike) {
  const Hypothesis delay = Of(axis_, "input_delay", 95.0);
  EXPECT_TRUE(SameTiming(axis_.problem, Of(axis_, "compliance", 100.0), delay, 12.0));
  EXPECT_FALSE(SameTiming(axis_.problem, Of(axis_, "cable_spring", 100.0), delay, 12.0));
  EXPECT_FALSE(SameTiming(axis_.problem, delay, Of(axis_, "compliance", 95.0), 12.0));
  const test::KnownAxis screw({.two_inertia = true});
  EXPECT_FALSE(
      SameTiming(screw.problem, Of(screw, "current_lag", 100.0), Of(screw, "input_delay", 95.0), 12.0))
      << "its coupling is known";
}

}  // namespace
}  // namespace contour::diagnosis
