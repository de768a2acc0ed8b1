#include "estimator/linear_friction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "estimator/friction_model.h"
#include "estimator/linear_friction_fit.h"

namespace contour {
namespace {

constexpr double kLead_m = 5e-3;

// Shape of friction in units of its level; `length` and `speed` scale the axis.
Friction Law(double level_N, double presliding_m, double vs_m_s) {
  const double sigma0 = level_N / presliding_m;
  return {1.25 * level_N, 1.2 * level_N,
          1.02 * level_N, 0.98 * level_N,
          vs_m_s,         1.0,
          sigma0,         0.3 * level_N / vs_m_s * 0.44,
          vs_m_s,         0.0};
}

// The 100 um circle at pi/4 Hz and the 10 mm circle at 3 m/min of an axis with 9 um of presliding and a
// Stribeck velocity of 2 mm/s, scaled.
struct Circle {
  double amplitude_m, frequency_Hz;
};
constexpr std::array<Circle, 3> kCircles{Circle{1e-4, std::numbers::pi / 4}, Circle{5e-3, 1.5915},
                                         Circle{2e-5, 1.0}};

struct Error {
  double rms = 0.0, most = 0.0;
};

// In units of the level, second turn. The law has its own fine steps; the terms go by the millisecond.
template <class Step>
Error Compare(const LinearFriction& basis, const FrictionTerms& parameters, const Circle& c, double length,
              double time, Step&& law) {
  FrictionTermsState memory;
  FrictionTerms terms{};
  Error error;
  constexpr int kFine = 20;
  const double period_s = 1e-3 * time, w = 2 * std::numbers::pi * c.frequency_Hz / time;
  const int turn = static_cast<int>(1e3 / c.frequency_Hz);
  int rows = 0;
  const double a = c.amplitude_m * length;
  for (int k = 0; k < 2 * turn; ++k) {
    double truth = 0.0;
    for (int i = 0; i < kFine; ++i) {
      const double t = (k + (i + 1.0) / kFine) * period_s, dt = period_s / kFine;
      truth = law(a * (std::sin(w * t) - std::sin(w * (t - dt))), a * w * std::cos(w * t), dt);
    }
    const double t = (k + 1) * period_s;
    basis.Follow(a * (std::sin(w * t) - std::sin(w * (t - period_s))), basis.scale().centre_m,
                 a * w * std::cos(w * t), 0.0, memory, terms);
    if (k < turn) continue;
    const double e = (Sum(terms, parameters) - truth) / basis.scale().level_N;
    error.rms += e * e;
    error.most = std::max(error.most, std::abs(e));
    ++rows;
  }
  error.rms = std::sqrt(error.rms / rows);
  return error;
}

Error LuGreError(double level_N, double length, double time, const Circle& c) {
  const Friction f = Law(level_N, 9e-6 * length, 2e-3 * length / time);
  const LinearFriction basis(ScaleOf(f, kLead_m * length, -0.2 * length, 0.2 * length));
  const FrictionTerms parameters = FitToLuGre(basis, f);
  double bristle_N = 0.0;
  return Compare(basis, parameters, c, length, time, [&](double step_m, double v, double dt) {
    bristle_N = BristleAfter(bristle_N, step_m / dt, f.sigma0_N_m, FrictionLevel(f, v), dt);
    return bristle_N + BristleDamping(f, bristle_N, v, FrictionLevel(f, v));
  });
}

TEST(LinearFriction, FitsLuGreOfTheCommissionedModel) {
  for (const Circle& c : kCircles) {
    const Error e = LuGreError(45.0, 1.0, 1.0, c);
    EXPECT_LT(e.rms, 0.04) << c.amplitude_m;
    EXPECT_LT(e.most, 0.075) << c.amplitude_m;
  }
}

TEST(LinearFriction, FitsAnAxisTenTimesAsLargeAsWell) {
  for (const Circle& c : kCircles) {
    const Error small = LuGreError(45.0, 1.0, 1.0, c), large = LuGreError(900.0, 10.0, 1.0, c),
                slow = LuGreError(5.0, 0.2, 3.0, c);
    EXPECT_NEAR(large.rms, small.rms, 1e-6) << c.amplitude_m;
    EXPECT_NEAR(large.most, small.most, 1e-6) << c.amplitude_m;
    EXPECT_NEAR(slow.most, small.most, 1e-6) << c.amplitude_m;
  }
}

/// Ten elements of break-away lengths spread logarithmically, each with a Stribeck curve that lags.
class MaxwellSlip {
 public:
  explicit MaxwellSlip(double level_N) : level_N_(level_N) {}
  double Step(double step_m, double v, double dt) {
    const double rise = 1.0 + 0.25 * std::exp(-std::abs(v) / 2e-3);
    rise_ += (rise - rise_) * (1.0 - std::exp(-dt / 2e-3));
    double sum = 0.0;
    for (std::size_t i = 0; i < z_m_.size(); ++i) {
      const double reach_m = 0.5e-6 * std::pow(40.0, static_cast<double>(i) / 9.0) * rise_;
      z_m_[i] = std::clamp(z_m_[i] + step_m, -reach_m, reach_m);
      sum += z_m_[i] / reach_m * rise_;
    }
    return sum * level_N_ / static_cast<double>(z_m_.size());
  }

 private:
  double level_N_;
  double rise_ = 1.25;
  std::array<double, 10> z_m_{};
};

// The same parameters for all circles: what learning can come to.
TEST(LinearFriction, FitsMaxwellSlip) {
  const Friction f = Law(45.0, 9e-6, 2e-3);
  const LinearFriction basis(ScaleOf(f, kLead_m, -0.2, 0.2));
  LinearFrictionFit fit;
  for (const Circle& c : kCircles) {
    MaxwellSlip law(45.0);
    FrictionTermsState memory;
    FrictionTerms terms{};
    const double w = 2 * std::numbers::pi * c.frequency_Hz;
    const int turn = static_cast<int>(1e3 / c.frequency_Hz);
    for (int k = 0; k < 2 * turn; ++k) {
      double truth = 0.0;
      for (int i = 0; i < 20; ++i) {
        const double t = (k + (i + 1.0) / 20) * 1e-3, dt = 5e-5;
        truth = law.Step(c.amplitude_m * (std::sin(w * t) - std::sin(w * (t - dt))),
                         c.amplitude_m * w * std::cos(w * t), dt);
      }
      const double t = (k + 1) * 1e-3;
      basis.Follow(c.amplitude_m * (std::sin(w * t) - std::sin(w * (t - 1e-3))), 0.0,
                   c.amplitude_m * w * std::cos(w * t), 0.0, memory, terms);
      fit.Add(terms, truth, 1.0 / turn);
    }
  }
  FrictionTerms std{};
  for (std::size_t i = 0; i < friction_term::kTurn; ++i) std[i] = 45.0;
  const FrictionTerms parameters = fit.Solve(std);
  for (const Circle& c : kCircles) {
    MaxwellSlip law(45.0);
    const Error e = Compare(basis, parameters, c, 1.0, 1.0,
                            [&](double step_m, double v, double dt) { return law.Step(step_m, v, dt); });
    EXPECT_LT(e.rms, 0.04) << c.amplitude_m;
    EXPECT_LT(e.most, 0.075) << c.amplitude_m;
  }
}

TEST(LinearFriction, AStandingAxisHoldsWhatItHas) {
  const Friction f = Law(45.0, 9e-6, 2e-3);
  const LinearFriction basis(ScaleOf(f, kLead_m, -0.2, 0.2));
  FrictionTermsState memory;
  FrictionTerms moving{}, standing{};
  for (int k = 1; k <= 20; ++k) basis.Follow(1e-6, k * 1e-6, 1e-9, 0.0, memory, moving);
  const FrictionTermsState before = memory;
  for (int k = 0; k < 1000; ++k) basis.Follow(0.0, 20e-6, 0.0, 0.0, memory, standing);
  EXPECT_EQ(memory, before);
  for (std::size_t i = 0; i < friction_term::kTurn; ++i) EXPECT_NEAR(standing[i], moving[i], 1e-5) << i;
}

// Shaken by 0.1 um a step: smooth bristles let go, of an axis that stands as well; a stop is held by its
// travel.
TEST(LinearFriction, AShakenAxisLetsGoOfWhatItHas) {
  const Friction f = Law(45.0, 9e-6, 2e-3);
  LinearFriction basis(ScaleOf(f, kLead_m, -0.2, 0.2));
  basis.Shake(1e-7);
  FrictionTermsState memory;
  FrictionTerms moving{}, standing{}, creeping{};
  for (int k = 1; k <= 100; ++k) basis.Follow(1e-6, k * 1e-6, 1e-9, 0.0, memory, moving);
  for (int k = 0; k < 1000; ++k) basis.Follow(0.0, 100e-6, 0.0, 0.0, memory, standing);
  for (int k = 0; k < 1000; ++k) basis.Follow(1e-7, 100e-6, 0.0, 0.0, memory, creeping);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t dahl = friction_term::kDahl + i, stop = friction_term::kStop + i;
    EXPECT_GT(moving[dahl], 0.9) << i;
    EXPECT_LT(standing[dahl], 0.1) << i;
    EXPECT_NEAR(standing[stop], moving[stop], 1e-12) << i;
    // As fast as it is shaken: one part of two, whose squares add up.
    EXPECT_NEAR(creeping[dahl], std::sqrt(0.5), 0.03) << i;
  }
}

}  // namespace
}  // namespace contour
