#include "estimator/coarse_encoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "estimator/two_inertia_estimator.h"
#include "tests/estimator/two_inertia_axes.h"

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr double kCoarse_m = 0.5e-6;

/// 100 N either way on average.
Friction Levels() {
  Friction f{};
  f.Fc_plus_N = 120.0;
  f.Fc_minus_N = 80.0;
  return f;
}

TEST(CountsHideFriction, WhereACountIsMoreThanFrictionMovesTheAxisByInACycle) {
  // 100 N on 50 kg: 1 um in a millisecond, a quarter of it in half of one.
  EXPECT_FALSE(CountsHideFriction(0.99e-6, Levels(), 50.0, 1e-3));
  EXPECT_TRUE(CountsHideFriction(1.01e-6, Levels(), 50.0, 1e-3));
  EXPECT_TRUE(CountsHideFriction(0.26e-6, Levels(), 50.0, 0.5e-3));
  EXPECT_FALSE(CountsHideFriction(1.01e-6, Levels(), 25.0, 1e-3));
  EXPECT_FALSE(CountsHideFriction(0.0, Levels(), 50.0, 1e-3));
  EXPECT_FALSE(CountsHideFriction(1.0, Friction{}, 50.0, 1e-3)) << "there is nothing to hide";
}

/// An axis of 89 kg with 36 N, whose friction moves it by 0.2 um in a cycle.
TwoInertiaEstimator::Setup Behind(double encoder_step_m, bool drive_closes_the_loop) {
  TwoInertiaEstimator::Setup s = test::EstimatorOf(test::kFamily[0], kPeriod_s, {});
  s.filter.encoder_step_m = encoder_step_m;
  s.filter.reported_torque = drive_closes_the_loop;
  return s;
}

/// Along a reference at constant velocity, where the axis is; it reports what it needs, and noise.
class Travel {
 public:
  Travel(const TwoInertiaEstimator::Setup& setup, bool enabled)
      : estimator_(std::make_unique<TwoInertiaEstimator>(setup)), enabled_(enabled) {}

  /// Friction that is foreseen for the next period.
  double Step(double velocity_m_s, double noise_N) {
    AxisHorizon ahead(6);
    for (std::size_t j = 0; j < ahead.size(); ++j)
      ahead[j] = {at_m_ + velocity_m_s * kPeriod_s * static_cast<double>(j), velocity_m_s, 0.0, 0.0, 0.0};
    AxisEstimatorInput in;
    in.position_m = at_m_;
    in.fresh = true;
    in.enabled = enabled_;
    const double force_N = ahead_N_ + noise_N;
    in.force_N = {force_N, force_N, force_N};
    in.commanded_velocity_m_s = velocity_m_s;
    in.at_rest = velocity_m_s == 0.0;
    estimator_->Update(in);
    FrictionPreview preview;
    estimator_->PreviewFriction(ahead, ahead.size(), preview);
    ahead_N_ = preview[0].node_N;
    at_m_ += velocity_m_s * kPeriod_s;
    return ahead_N_;
  }

 private:
  std::unique_ptr<TwoInertiaEstimator> estimator_;
  bool enabled_;
  double at_m_ = 0.0, ahead_N_ = 0.0;
};

// What the drive reports scatters by twice the level from one sample to the next.
double Scatter_N(const TwoInertiaEstimator::Setup& setup) {
  Travel travel(setup, true);
  std::mt19937_64 bits(1);
  double least_N = 1e9, most_N = -1e9;
  for (int k = 0; k < 4000; ++k) {
    const double ahead_N = travel.Step(10e-3, bits() % 2 == 0 ? 72.0 : -72.0);
    if (k < 2000) continue;
    least_N = std::min(least_N, ahead_N);
    most_N = std::max(most_N, ahead_N);
  }
  return most_N - least_N;
}

TEST(CoarseEncoder, NoiseOfReportsIsNotForeseenAsFriction) {
  const double coarse_N = Scatter_N(Behind(kCoarse_m, true)), fine_N = Scatter_N(Behind(5e-9, true));
  EXPECT_LT(coarse_N, 0.25 * fine_N);
  EXPECT_LT(coarse_N, 0.15 * 36.0);
}

// What is left foreseen of an axis that stands, over what it had in motion; nothing of it is measured.
double Left(const TwoInertiaEstimator::Setup& setup) {
  Travel travel(setup, false);
  double moving_N = 0.0, standing_N = 0.0;
  for (int k = 0; k < 500; ++k) moving_N = travel.Step(10e-3, 0.0);
  for (int k = 0; k < 500; ++k) standing_N = travel.Step(0.0, 0.0);
  return standing_N / moving_N;
}

TEST(CoarseEncoder, OnlyADriveThatAnswersItsCountsShakesFrictionLoose) {
  EXPECT_LT(Left(Behind(kCoarse_m, true)), 0.2);
  EXPECT_GT(Left(Behind(5e-9, true)), 0.7);
  EXPECT_GT(Left(Behind(kCoarse_m, false)), 0.7) << "in torque mode";
}

}  // namespace
}  // namespace contour
