#include "analysis/diagnosis/quantification/follow_play.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "analysis/prediction_error/refit.h"
#include "tests/analysis/support/fitted_axis.h"

namespace contour::diagnosis {
namespace {

Accepted Of(Fit fit) {
  Accepted accepted;
  accepted.fit = std::move(fit);
  accepted.places = {0};
  accepted.scatter = {1.0};
  return accepted;
}

test::HiddenOptions SoftScrew(std::vector<test::HiddenEffect> effects) {
  test::HiddenOptions o = test::FittedAxis::Short(std::move(effects));
  o.two_inertia = true;
  return o;
}

TEST(FollowPlay, WithoutAPlayNothingChanges) {
  test::FittedAxis axis({{"constant_torque", 0.3, 0.0, 0.0, 0.0}});
  Accepted accepted = Of(axis.With(axis.Of("constant_torque")));
  const ObserverGain before = axis.made.problem.setup.gain;
  const Fit fit = accepted.fit;
  Fit nominal = axis.base;
  FollowPlay(axis.made.problem, accepted, nominal);
  EXPECT_EQ(nominal.cost, axis.base.cost);
  EXPECT_TRUE(accepted.by_slow_observer.effects.empty());
  EXPECT_EQ(axis.made.problem.setup.gain, before);
  EXPECT_EQ(accepted.fit.point.amplitudes, fit.point.amplitudes);
}

TEST(FollowPlay, AQuickerObserverFitsThePlayAnew) {
  test::FittedAxis axis(SoftScrew({{"backlash", 1.0, 0.0, 0.0, 0.0}}));
  Problem& problem = axis.made.problem;
  Accepted accepted = Of(axis.With(axis.Of("backlash")));
  ASSERT_GT(problem.Build(accepted.fit.point).gap, 0.0);
  const Point slow = accepted.fit.point;
  const ObserverGain before = problem.setup.gain_two;
  Fit nominal = axis.base;
  FollowPlay(problem, accepted, nominal);
  EXPECT_EQ(accepted.by_slow_observer.amplitudes, slow.amplitudes);
  EXPECT_GT(problem.setup.gain_two[0], before[0]);
  // The fit is of that observer and its noise, and none that ends above where it began.
  EXPECT_NEAR(accepted.fit.cost, CostAt(problem, accepted.fit.point), 1e-6 * accepted.fit.cost);
  EXPECT_LE(accepted.fit.cost, CostAt(problem, slow));
  EXPECT_NEAR(nominal.cost, CostAt(problem, nominal.point), 1e-6 * nominal.cost)
      << "and so is the base alone";
  EXPECT_GT(problem.Build(accepted.fit.point).gap, 0.0);
}

TEST(FollowPlay, WhatDoesNotShowBehindTheQuickerObserverStaysAsItWasAndIsABound) {
  test::FittedAxis axis(SoftScrew({}));
  Problem& problem = axis.made.problem;
  Accepted accepted = Of(axis.With(axis.Of("backlash")));
  // A play that is not there, as a slow observer might leave one.
  accepted.fit.point.amplitudes[0][0] = 1e-3 * axis.Of("backlash")->start[0];
  ASSERT_GT(problem.Build(accepted.fit.point).gap, 0.0);
  const Point point = accepted.fit.point;
  const ObserverGain before = problem.setup.gain_two;
  const double log_noise = problem.LogNoise();
  Fit nominal = axis.base;
  FollowPlay(problem, accepted, nominal);
  EXPECT_TRUE(accepted.play_is_bound);
  EXPECT_EQ(accepted.fit.point, point);
  EXPECT_TRUE(accepted.by_slow_observer.effects.empty());
  EXPECT_EQ(problem.setup.gain_two, before);
  EXPECT_EQ(problem.LogNoise(), log_noise);
  EXPECT_EQ(nominal.cost, axis.base.cost);
}

TEST(FollowPlay, WhatTheObserverChangedIsNotKnownBetter) {
  test::FittedAxis axis({{"constant_torque", 0.3, 0.0, 0.0, 0.0}});
  Accepted accepted = Of(axis.With(axis.Of("constant_torque")));
  const double torque = accepted.fit.point.amplitudes[0][0];
  Cause cause;
  cause.kind = "constant_torque";
  const Interval narrow = {torque, torque - 3e-4, torque + 3e-4};
  cause.parameters["torque_Nm"] = narrow;
  WidenByObserver(axis.problem, accepted, 0, cause);
  EXPECT_EQ(cause.parameters["torque_Nm"].low, narrow.low);
  accepted.by_slow_observer = accepted.fit.point;
  accepted.by_slow_observer.amplitudes[0][0] += 4e-4;
  WidenByObserver(axis.problem, accepted, 0, cause);
  const Interval wide = cause.parameters["torque_Nm"];
  EXPECT_EQ(wide.value, torque);
  EXPECT_NEAR(wide.low, torque - 5e-4, 1e-9);
  EXPECT_NEAR(wide.high, torque + 5e-4, 1e-9);
}

}  // namespace
}  // namespace contour::diagnosis
