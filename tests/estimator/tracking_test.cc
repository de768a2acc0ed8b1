#include <gtest/gtest.h>

#include <cmath>

#include "tests/estimator/screw_axis.h"

// How close the estimates come to the truth of a plant with its own integration, under a deliberately wrong
// model.
namespace contour {
namespace {

using test::Loop;
using test::ScrewAxis;
using test::SmoothSine;
using test::WrongFriction;
using test::WrongMechanics;

struct Score {
  double friction_rms_N = 0.0;
  double covered = 0.0;  ///< share of cycles with the error within two standard deviations
  double position_peak_m = 0.0;
};

Score Track(Loop& loop, const SmoothSine& motion, double seconds, double from_s) {
  Score s;
  int n = 0;
  for (int k = 0; k < static_cast<int>(seconds * 1e3); ++k) {
    const AxisEstimate e = loop.Step(motion);
    if (k * 1e-3 < from_s) continue;
    const double error = e.friction_N - loop.true_friction_N;
    s.friction_rms_N += error * error;
    s.covered += std::abs(error) < 2.0 * e.friction_std_N ? 1.0 : 0.0;
    s.position_peak_m =
        std::max(s.position_peak_m,
                 std::abs(loop.axis.s.motor_m - motion(static_cast<double>(loop.cycle) * 1e-3).position_m));
    ++n;
  }
  s.friction_rms_N = std::sqrt(s.friction_rms_N / n);
  s.covered /= n;
  return s;
}

Loop Make(EstimatorKind kind, const EstimatorConfig& config = {}) {
  return {kind, WrongMechanics(), WrongFriction(), config};
}

const SmoothSine kSlow{100e-6, 0.125, 0.2};
const SmoothSine kMiddle{100e-6, 0.7854, 0.2};
const SmoothSine kFast{10e-3, 0.7958, 0.2};  // 50 mm/s

TEST(Tracking, FrictionWithinOneNewtonOnTheCirclesOfTheContest) {
  for (const auto kind : {EstimatorKind::kEkf7, EstimatorKind::kSrukf7, EstimatorKind::kFull}) {
    Loop slow = Make(kind), middle = Make(kind), fast = Make(kind);
    EXPECT_LT(Track(slow, kSlow, 9.0, 4.5).friction_rms_N, 1.0) << static_cast<int>(kind);
    EXPECT_LT(Track(middle, kMiddle, 4.0, 1.5).friction_rms_N, 1.0) << static_cast<int>(kind);
    EXPECT_LT(Track(fast, kFast, 4.5, 1.5).friction_rms_N, 1.25) << static_cast<int>(kind);
  }
}

TEST(Tracking, StandardDeviationCoversTheError) {
  for (const auto& motion : {kMiddle, kFast}) {
    Loop loop = Make(EstimatorKind::kFull);
    EXPECT_GT(Track(loop, motion, 4.0, 1.5).covered, 0.9);
  }
}

TEST(Tracking, LevelsOfBothDirectionsAreFound) {
  Loop loop = Make(EstimatorKind::kFull);
  loop.axis.ripple_part = loop.axis.stroke_part = 0.0;
  Track(loop, kFast, 6.0, 0.0);
  EXPECT_NEAR(loop.estimate.g_plus_N, 42.0, 3.5);   // from 36
  EXPECT_NEAR(loop.estimate.g_minus_N, 36.0, 3.5);  // from 41
}

TEST(Tracking, StiffnessOfThePreslidingRegimeIsFound) {
  for (const double factor : {3.0, 1.0 / 3.0}) {
    Loop loop = Make(EstimatorKind::kFull);
    loop.axis.sigma0_N_m = 4.2e6 * factor;
    Track(loop, kMiddle, 8.0, 0.0);
    EXPECT_GT(loop.estimate.sigma0_N_m, 4.2e6 * factor / 1.8) << factor;
    EXPECT_LT(loop.estimate.sigma0_N_m, 4.2e6 * factor * 1.8) << factor;
  }
}

TEST(Tracking, BetterModelsTrackBetter) {
  const auto peak = [](EstimatorKind kind) {
    Loop loop = Make(kind);
    return Track(loop, kFast, 4.0, 1.5).position_peak_m;
  };
  const double none = peak(EstimatorKind::kKinematic);
  const double observer = peak(EstimatorKind::kDisturbanceObserver);
  const double seven = peak(EstimatorKind::kSrukf7);
  const double full = peak(EstimatorKind::kFull);
  EXPECT_LT(observer, none);
  EXPECT_LT(seven, 0.3 * observer);
  EXPECT_LT(full, seven);
}

TEST(Tracking, FrozenParametersAreWorse) {
  EstimatorConfig frozen;
  frozen.adapt = false;
  Loop a = Make(EstimatorKind::kFull), b = Make(EstimatorKind::kFull, frozen);
  const double adapting = Track(a, kFast, 4.0, 1.5).position_peak_m;
  const double fixed = Track(b, kFast, 4.0, 1.5).position_peak_m;
  EXPECT_GT(fixed, 1.5 * adapting);
  EXPECT_EQ(b.estimate.g_plus_N, 36.0);
  EXPECT_EQ(b.estimate.g_minus_N, 41.0);
  EXPECT_DOUBLE_EQ(b.estimate.sigma0_N_m, 4.2e6);
}

TEST(Tracking, ACuttingForceGoesIntoTheDisturbanceNotTheLevel) {
  // Struck in full motion; what a lasting force becomes later (d leaks) is another matter.
  Loop loop = Make(EstimatorKind::kFull);
  Track(loop, kFast, 3.0, 0.0);
  const double plus = loop.estimate.g_plus_N, minus = loop.estimate.g_minus_N;
  const double before = loop.estimate.disturbance_N;
  loop.axis.extra_force_N = 60.0;
  Track(loop, kFast, 0.05, 0.0);
  EXPECT_GT(loop.estimate.disturbance_N - before, 30.0);
  EXPECT_NEAR(loop.estimate.friction_N, loop.true_friction_N, 5.0);
  EXPECT_LT(std::abs(loop.estimate.g_plus_N - plus) + std::abs(loop.estimate.g_minus_N - minus), 20.0);
}

TEST(Tracking, TheTorqueOfAnotherAxisSpoilsTheEstimate) {
  Loop right = Make(EstimatorKind::kFull), wrong = Make(EstimatorKind::kFull);
  Loop other = Make(EstimatorKind::kFull);
  const double good = Track(right, kMiddle, 3.0, 1.5).friction_rms_N;
  double square = 0.0;
  int n = 0;
  const SmoothSine late{100e-6, 0.7854, 0.5};
  for (int k = 0; k < 3000; ++k) {
    other.Step(late);
    // Its estimator is fed the other axis's torque; the plant still gets its own.
    const auto own = wrong.past_N;
    wrong.past_N = other.past_N;
    wrong.Step(kMiddle);
    wrong.past_N[1] = own[0];
    wrong.past_N[2] = own[1];
    if (k > 1500) {
      square += std::pow(wrong.estimate.friction_N - wrong.true_friction_N, 2);
      ++n;
    }
  }
  EXPECT_GT(std::sqrt(square / n), 5.0 * good);
}

}  // namespace
}  // namespace contour
