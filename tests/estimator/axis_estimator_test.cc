#include "estimator/axis_estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/estimator/screw_axis.h"
#include "tests/support/allocation_guard.h"

namespace contour {
namespace {

using test::Loop;
using test::SmoothSine;
using test::WrongFriction;
using test::WrongMechanics;

constexpr EstimatorKind kAll[] = {EstimatorKind::kKinematic, EstimatorKind::kDisturbanceObserver,
                                  EstimatorKind::kSrukf4,    EstimatorKind::kEkf7,
                                  EstimatorKind::kSrukf7,    EstimatorKind::kFull};

AxisEstimator Make(EstimatorKind kind) {
  return {kind, WrongMechanics(), WrongFriction(), EstimatorConfig{}, 1e-3, 0.2e-3, 5e-3 / 1048576};
}

TEST(AxisEstimator, RefusesValuesThatMakeNoSense) {
  const Mechanics m = WrongMechanics();
  const FrictionConfig f = WrongFriction();
  const auto make = [](const Mechanics& mechanics, const FrictionConfig& friction, double period,
                       double lag) {
    return AxisEstimator(EstimatorKind::kFull, mechanics, friction, EstimatorConfig{}, period, lag);
  };
  EXPECT_NO_THROW(make(m, f, 1e-3, 0.0));
  EXPECT_THROW(make(m, f, 0.0, 0.0), std::invalid_argument);
  EXPECT_THROW(make(m, f, 1e-3, -1.0), std::invalid_argument);
  Mechanics bad = m;
  bad.mass_kg = 0.0;
  EXPECT_THROW(make(bad, f, 1e-3, 0.0), std::invalid_argument);
  bad = m;
  bad.stiffness_N_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(make(bad, f, 1e-3, 0.0), std::invalid_argument);
  bad = m;
  bad.table_mass_kg = 2.0 * bad.mass_kg;
  EXPECT_THROW(make(bad, f, 1e-3, 0.0), std::invalid_argument);
  FrictionConfig worse = f;
  worse.sigma0_N_m = -1.0;
  EXPECT_THROW(make(m, worse, 1e-3, 0.0), std::invalid_argument);
  worse = f;
  worse.Fc_minus_N = 0.0;
  EXPECT_THROW(make(m, worse, 1e-3, 0.0), std::invalid_argument);
}

TEST(AxisEstimator, NeverTouchesTheHeap) {
  if (!test::AllocationGuard::kAvailable) GTEST_SKIP() << "the sanitizer owns the heap";
  for (const auto kind : kAll) {
    AxisEstimator estimator = Make(kind);
    AxisHorizon horizon(kMaxHorizonPoints);
    FrictionPreview preview;
    const test::AllocationGuard guard;
    estimator.Reset(0.01);
    for (int k = 0; k < 200; ++k) {
      AxisEstimator::Input in;
      in.position_m = 0.01 + 1e-6 * k;
      in.fresh = k % 7 != 0;
      in.force_N = {40.0, 41.0, 42.0};
      in.at_rest = k > 150;
      in.enabled = k > 3;
      estimator.Update(in);
      estimator.PreviewFriction(horizon, horizon.size(), preview);
    }
    EXPECT_EQ(guard.calls(), 0u) << static_cast<int>(kind);
  }
}

TEST(AxisEstimator, FollowsTheEncoderWhileNotEnabled) {
  for (const auto kind : kAll) {
    AxisEstimator estimator = Make(kind);
    estimator.Reset(0.0);
    AxisEstimate e;
    for (int k = 0; k < 3000; ++k) {
      AxisEstimator::Input in;
      in.position_m = 1e-5 * k;  // pushed by hand at 10 mm/s
      in.fresh = true;
      in.force_N = {300.0, 300.0, 300.0};  // commands that act on nothing
      e = estimator.Update(in);
    }
    EXPECT_NEAR(e.position_m, 1e-5 * 2999, 2e-6) << static_cast<int>(kind);
    EXPECT_FALSE(e.diverged);
    EXPECT_NEAR(e.disturbance_N, 0.0, 1e-9) << static_cast<int>(kind);
  }
}

TEST(AxisEstimator, EveryFieldOfTheFrictionFiltersIsFilled) {
  for (const auto kind : {EstimatorKind::kEkf7, EstimatorKind::kSrukf7, EstimatorKind::kFull}) {
    Loop loop(kind, WrongMechanics(), WrongFriction(), {});
    for (int k = 0; k < 2000; ++k) loop.Step(SmoothSine{});
    const AxisEstimate& e = loop.estimate;
    EXPECT_NE(e.position_m, 0.0);
    EXPECT_NE(e.velocity_m_s, 0.0);
    EXPECT_NEAR(e.predicted_position_m - e.position_m, 1e-3 * e.velocity_m_s, 2e-8);
    EXPECT_NE(e.predicted_velocity_m_s, 0.0);
    // What is left is the damping of the bristle: at most sigma1 times twice the speed.
    EXPECT_NEAR(e.friction_N, e.bristle_N + e.disturbance_N + 560.0 * e.velocity_m_s,
                2.0 * 2500.0 * std::abs(e.velocity_m_s));
    EXPECT_GT(e.friction_std_N, 0.0);
    EXPECT_NE(e.g_plus_N, 36.0);
    EXPECT_NE(e.g_minus_N, 41.0);
    EXPECT_NE(e.sigma0_N_m, 4.2e6);
    EXPECT_GT(e.innovation_std_m, 0.0);
  }
}

TEST(AxisEstimator, TheKinematicObserverKnowsNoFriction) {
  Loop loop(EstimatorKind::kKinematic, WrongMechanics(), WrongFriction(), {});
  for (int k = 0; k < 1500; ++k) loop.Step(SmoothSine{});
  EXPECT_EQ(loop.estimate.friction_N, 0.0);
  EXPECT_EQ(loop.estimate.friction_std_N, 0.0);
  ASSERT_EQ(loop.preview.size(), 6u);
  for (const auto& f : loop.preview) EXPECT_EQ(f.mid_N, 0.0);
}

TEST(AxisEstimator, PredictionIsWhereTheAxisWillBe) {
  for (const auto kind :
       {EstimatorKind::kKinematic, EstimatorKind::kDisturbanceObserver, EstimatorKind::kSrukf4,
        EstimatorKind::kEkf7, EstimatorKind::kSrukf7, EstimatorKind::kFull}) {
    Loop loop(kind, WrongMechanics(), WrongFriction(), {});
    const SmoothSine motion{5e-3, 1.0, 0.2};
    double square = 0.0;
    int n = 0;
    for (int k = 0; k < 2500; ++k) {
      // Step() reads the encoder at t(k) after the estimate is made: what was predicted.
      const double predicted = loop.Step(motion).predicted_position_m;
      if (k > 800) {
        square += std::pow(predicted - loop.measured_m, 2);
        ++n;
      }
    }
    // 1 ms at 31 mm/s is 31 um.
    EXPECT_LT(std::sqrt(square / n), 0.3e-6) << static_cast<int>(kind);
  }
}

TEST(AxisEstimator, TheSameInputGivesTheSameBits) {
  Loop a(EstimatorKind::kFull, WrongMechanics(), WrongFriction(), {});
  Loop b(EstimatorKind::kFull, WrongMechanics(), WrongFriction(), {});
  for (int k = 0; k < 1000; ++k) {
    const AxisEstimate x = a.Step(SmoothSine{});
    const AxisEstimate y = b.Step(SmoothSine{});
    ASSERT_EQ(x.friction_N, y.friction_N);
    ASSERT_EQ(x.predicted_position_m, y.predicted_position_m);
  }
}

TEST(AxisEstimator, ResetForgetsEverything) {
  Loop loop(EstimatorKind::kFull, WrongMechanics(), WrongFriction(), {});
  for (int k = 0; k < 3000; ++k) loop.Step(SmoothSine{1e-3, 2.0, 0.1});
  loop.estimator.Reset(0.02);
  AxisEstimator fresh = Make(EstimatorKind::kFull);
  fresh.Reset(0.02);
  AxisEstimator::Input in;
  in.position_m = 0.02;
  in.fresh = in.enabled = true;
  in.at_rest = false;
  for (int k = 0; k < 50; ++k) {
    in.force_N[2] = in.force_N[1];
    in.force_N[1] = in.force_N[0];
    in.force_N[0] = 20.0 + k;
    in.position_m += 1e-7;
    const auto a = loop.estimator.Update(in);
    const auto b = fresh.Update(in);
    ASSERT_EQ(a.friction_N, b.friction_N) << k;
    ASSERT_EQ(a.g_plus_N, b.g_plus_N) << k;
  }
}

}  // namespace
}  // namespace contour
