#include "estimator/two_inertia_observer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/estimator/two_inertia_axes.h"

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;

// The design's own model as the axis: what the observer sees, it sees without error.
class OwnAxis {
 public:
  explicit OwnAxis(const TwoInertiaAxis& axis) : loop_(LoopMotionOf(axis, kPeriod_s)) {}
  void Step(double input_N, double table_N) {
    LoopMotion next{};
    for (std::size_t i = 0; i < kLoopMotion; ++i) {
      next[i] = loop_.motion_from_input[0][i] * input_N + loop_.motion_from_disturbance[i] * table_N;
      for (std::size_t j = 0; j < kLoopMotion; ++j) next[i] += loop_.motion_from_motion[i][j] * x[j];
    }
    x = next;
  }
  LoopMotion x{};

 private:
  TwoInertiaLoop loop_;
};

TEST(TwoInertiaObserver, FindsAForceOnTheTableAsItsResponseSays) {
  for (const test::FamilyAxis& member : test::kFamily) {
    const TwoInertiaObserver::Setup setup = test::ObserverOf(member, kPeriod_s);
    TwoInertiaObserver observer(setup);
    OwnAxis axis(setup.axis);
    observer.Reset(0.0);
    // A force over the first period alone.
    const double force_N = member.friction_N;
    double found_N = 0.0;
    for (std::size_t j = 0; j < kLoopTaps; ++j) {
      if (j > 0) observer.Predict({{0.0, 0.0}, 0.0, 0.0});
      observer.Correct(axis.x[0]);
      EXPECT_NEAR(observer.disturbance_N(), setup.loop.disturbance_response[j] * force_N, 1e-6 * force_N)
          << member.name << " " << j;
      axis.Step(0.0, j == 0 ? force_N : 0.0);
      found_N += observer.disturbance_N();
    }
    EXPECT_NEAR(found_N, force_N, 0.05 * force_N) << member.name;
  }
}

// Before: a reading that came after four periods was taken for what one period had brought. What it found
// swung, more each time.
TEST(TwoInertiaObserver, ReadingsThatComeSeldomAreNotTakenForSudden) {
  for (const test::FamilyAxis& member : test::kFamily)
    for (const int every : {2, 4, 7}) {
      const TwoInertiaObserver::Setup setup = test::ObserverOf(member, kPeriod_s);
      TwoInertiaObserver observer(setup);
      OwnAxis axis(setup.axis);
      observer.Reset(0.0);
      const double force_N = 0.1 * member.friction_N;
      for (int k = 0; k < 600; ++k) {
        if (k > 0) observer.Predict({{0.0, 0.0}, 0.0, 0.0});
        if (k % every == 0) observer.Correct(axis.x[0]);
        axis.Step(0.0, force_N);
      }
      EXPECT_NEAR(observer.disturbance_N(), force_N, 0.1 * force_N) << member.name << " " << every;
    }
}

// Before: readings were left out for 20 ms, in which a loop that went by what was foretold took the axis as
// far as it liked; then the observer began at rest, and left them out again.
TEST(TwoInertiaObserver, ReadingsThatAgreeOnAnotherMotionAreSoonBelieved) {
  constexpr double kSpeed_m_s = 0.15;
  for (const bool scale : {false, true}) {
    TwoInertiaObserver::Setup setup = test::ObserverOf(test::kFamily[1], kPeriod_s);
    LoopTuning tuning = test::kSteadyTuning;
    tuning.bias_Hz = 100.0;
    if (scale) setup.scale_loop = DesignLoop(setup.axis, tuning, kPeriod_s, true);
    TwoInertiaObserver observer(setup);
    observer.Reset(0.0);
    int left_out = 0;
    for (int k = 1; k <= 10; ++k) {
      observer.Predict({{0.0, 0.0}, 0.0, 0.0});
      const double position_m = kSpeed_m_s * kPeriod_s * k;
      left_out +=
          (scale ? observer.Correct(position_m, position_m) : observer.Correct(position_m)).gated ? 1 : 0;
    }
    EXPECT_EQ(left_out, 3) << scale;
    EXPECT_NEAR(observer.motion()[1], kSpeed_m_s, 0.01 * kSpeed_m_s) << scale;
    EXPECT_NEAR(observer.motion()[2], kSpeed_m_s * kPeriod_s * 10, 1e-6) << scale;
  }
}

TEST(TwoInertiaObserver, ByTheScaleItFindsTheTableWhateverTheEncoderIsOffBy) {
  for (const test::FamilyAxis& member : test::kFamily) {
    TwoInertiaObserver::Setup setup = test::ObserverOf(member, kPeriod_s);
    LoopTuning tuning = test::kSteadyTuning;
    tuning.bias_Hz = 100.0;
    setup.scale_loop = DesignLoop(setup.axis, tuning, kPeriod_s, true);
    TwoInertiaObserver observer(setup);
    OwnAxis axis(setup.axis);
    // Encoder and scale begin a micrometre apart, and drift by as much again.
    observer.Reset(1e-6, 0.0);
    double beyond_m = 0.0;
    for (std::size_t k = 0; k < 400; ++k) {
      beyond_m = 1e-6 * (1.0 + static_cast<double>(k) / 400.0);
      const double input_N = 40.0 * std::sin(0.05 * static_cast<double>(k));
      if (k > 0) observer.Predict({{input_N, 0.0}, 0.0, 0.0});
      observer.Correct(axis.x[0] + beyond_m, axis.x[2]);
      if (k > 50) {
        EXPECT_NEAR(observer.motion()[2], axis.x[2], 10e-9) << member.name << " " << k;
      }
      axis.Step(40.0 * std::sin(0.05 * static_cast<double>(k + 1)), 0.0);
    }
    EXPECT_NEAR(observer.beyond_m(), beyond_m, 0.35e-6) << member.name;
    // The scale is gone: the motor is where its encoder is, the table behind by the wind-up.
    observer.GoOnByMotor(5e-6, 40.0, 7.0);
    EXPECT_DOUBLE_EQ(observer.motion()[0], 5e-6);
    EXPECT_DOUBLE_EQ(observer.motion()[2], 5e-6 - 40.0 / setup.axis.stiffness_N_m);
    EXPECT_EQ(observer.beyond_m(), 0.0);
    EXPECT_EQ(observer.disturbance_N(), 7.0);
  }
}

TEST(TwoInertiaObserver, WhatIsKnownIsNotFound) {
  const test::FamilyAxis& member = test::kFamily[1];
  const TwoInertiaObserver::Setup setup = test::ObserverOf(member, kPeriod_s);
  TwoInertiaObserver observer(setup);
  OwnAxis axis(setup.axis);
  observer.Reset(0.0);
  for (int k = 0; k < 300; ++k) {
    const double input_N = 40.0 * std::sin(0.05 * k), table_N = 30.0 * std::cos(0.02 * k);
    axis.Step(input_N, table_N);
    observer.Predict({{input_N, 0.0}, 0.0, table_N});
    observer.Correct(axis.x[0]);
    EXPECT_NEAR(observer.disturbance_N(), 0.0, 1e-5);
    EXPECT_NEAR(observer.motion()[2], axis.x[2], 1e-12);
  }
}

TEST(TwoInertiaObserver, FarFromTheOriginNothingIsLost) {
  const test::FamilyAxis& member = test::kFamily[0];
  const TwoInertiaObserver::Setup setup = test::ObserverOf(member, kPeriod_s);
  TwoInertiaObserver here(setup), far(setup);
  here.Reset(0.0);
  far.Reset(8.0);
  for (int k = 0; k < 200; ++k) {
    const PeriodForces f{{50.0, 0.0}, 1.0, 20.0};
    here.Predict(f);
    far.Predict(f);
    const double position_m = 1e-6 * k;
    here.Correct(position_m);
    far.Correct(8.0 + position_m);
    EXPECT_NEAR(far.disturbance_N(), here.disturbance_N(), 1e-3);
  }
}

TEST(TwoInertiaObserver, ASingleReadingThatIsFarOffIsNotBelieved) {
  const TwoInertiaObserver::Setup setup = test::ObserverOf(test::kFamily[0], kPeriod_s);
  TwoInertiaObserver observer(setup);
  observer.Reset(0.0);
  for (int k = 0; k < 10; ++k) {
    observer.Predict({});
    EXPECT_FALSE(observer.Correct(0.0).gated);
  }
  observer.Predict({});
  EXPECT_TRUE(observer.Correct(100e-6).gated);
  EXPECT_EQ(observer.disturbance_N(), 0.0);
  observer.Predict({});
  EXPECT_FALSE(observer.Correct(0.0).gated);
}

// A lag of three periods: what was given while nothing was learnt still acts after it.
TEST(TwoInertiaEstimator, KnowsWhatTheDriveGaveWhileNothingWasLearnt) {
  TwoInertiaEstimator::Setup setup = test::EstimatorOf(test::kFamily[0], 1e-3, {});
  setup.filter.lag_s = setup.axis.lag_s = 3e-3;
  setup.loop = DesignLoop(setup.axis, test::kSteadyTuning, 1e-3, false);
  TwoInertiaEstimator estimator(setup);
  estimator.Reset(0.0);
  AxisEstimatorInput in;
  in.enabled = in.fresh = true;
  in.force_N = {20.0, 20.0, 20.0};
  estimator.Freeze(true);
  for (int k = 0; k < 60; ++k) estimator.Update(in);
  EXPECT_NEAR(estimator.acted_N(), 20.0, 0.01);
  in.enabled = false;
  in.force_N = {};
  for (int k = 0; k < 60; ++k) estimator.Update(in);
  EXPECT_NEAR(estimator.acted_N(), 0.0, 0.01);
}

}  // namespace
}  // namespace contour
