#include "estimator/seven_state_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace contour {
namespace {

using X = StateVector<kSevenStates>;

Friction Nominal(double exponent = 1.0) { return {52, 47, 42, 36, 2e-3, exponent, 5e6, 3000, 2e-3, 500}; }

X RandomState(std::mt19937& random, double speed) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  X x{};
  x[kPosition] = 0.1 * u(random);
  x[kVelocity] = speed * u(random);
  x[kBristle] = 45 * u(random);
  x[kDisturbance] = 10 * u(random);
  x[kLevelPlus] = 42 + 10 * u(random);
  x[kLevelMinus] = 36 + 10 * u(random);
  x[kLogSigma0] = u(random);
  return x;
}

TEST(SevenStateModel, OnePeriodMatchesAFineIntegration) {
  const double mass = 89.0, period = 1e-3;
  for (const double exponent : {1.0, 2.0, 1.3}) {
    const Friction f = Nominal(exponent);
    const SevenStateModel model(f, mass, period, 0.2);
    std::mt19937 random(1);
    for (int trial = 0; trial < 40; ++trial) {
      const double speed = std::pow(10.0, -5.0 + 4.0 * trial / 40.0);
      X x = RandomState(random, speed);
      // Away from a reversal within the period, where two substeps are not meant to follow.
      x[kVelocity] = std::copysign(std::abs(x[kVelocity]) + 0.2 * speed, x[kVelocity]);
      const double sigma1 = 3000.0 * std::exp(-std::pow(x[kVelocity] / 2e-3, 2));
      const SevenStateInput in{{60.0, 40.0}, 1.05, 0.9, sigma1};
      EXPECT_NEAR(model.TermsAt(x[kVelocity]).sigma1_Ns_m, sigma1, 1e-9);
      X coarse = x;
      model.Propagate(coarse, in);

      const int n = 20000;
      const double h = period / n;
      double p = x[kPosition], v = x[kVelocity], F = x[kBristle], d = x[kDisturbance];
      for (int k = 0; k < n; ++k) {
        const double u = k < n / 2 ? in.force_N[0] : in.force_N[1];
        const double fc = v >= 0 ? x[kLevelPlus] * 1.05 : x[kLevelMinus] * 0.9;
        const double ratio = v >= 0 ? 52.0 / 42.0 : 47.0 / 36.0;
        const double g = fc * (1 + (ratio - 1) * std::exp(-std::pow(std::abs(v) / 2e-3, exponent)));
        const double s0 = 5e6 * std::exp(x[kLogSigma0]);
        const double dF = s0 * (v - std::abs(v) * F / g);
        const double dv = (u - F - sigma1 * dF / s0 - 500 * v - d) / mass;
        p += h * v + 0.5 * h * h * dv;
        F += h * dF;
        v += h * dv;
        d -= h * d / 0.2;
      }
      // A bristle started anywhere may jump by up to 90 N within a period; the steps put its end value into
      // the whole substep's balance, for stability. Tolerances are shares of what 100 N do to the axis in a
      // period.
      const double dv = 100.0 / mass * period;
      EXPECT_NEAR(coarse[kPosition], p, 0.12 * dv * period) << trial;
      EXPECT_NEAR(coarse[kVelocity], v, 0.15 * dv) << trial;
      EXPECT_NEAR(coarse[kBristle], F, 5.0) << trial;
      EXPECT_NEAR(coarse[kDisturbance], d, 1e-3) << trial;
      EXPECT_EQ(coarse[kLevelPlus], x[kLevelPlus]);
      EXPECT_EQ(coarse[kLevelMinus], x[kLevelMinus]);
      EXPECT_EQ(coarse[kLogSigma0], x[kLogSigma0]);
    }
  }
}

// A level that was given up, and a bristle that still holds the other way: it lets go within the period, and
// its damping is no force. Before: -82 mm/s of an axis that an outside force moved forwards.
TEST(SevenStateModel, ABristleWithoutALevelDoesNotThrowTheAxisBack) {
  const Friction f{11, 13.5, 10.5, 8.2, 4.5e-3, 1.0, 1.1e6, 360, 3e-3, 55};
  const SevenStateModel model(f, 6.42, 1e-3, 0.2, 30e-9);
  X x{};
  x[kVelocity] = 1e-3;
  x[kBristle] = -12.0;
  x[kLevelPlus] = 0.00175;
  x[kLevelMinus] = 3.3;
  const SevenStateInput in{{0.0, 0.0}, 1.0, 1.0, 350.0};
  X tangent_mean = x;
  model.Propagate(x, in);
  EXPECT_GT(x[kVelocity], 0.0);
  EXPECT_LT(x[kVelocity], 1e-3 + 12.0 / 6.42 * 1e-3);
  SquareMatrix<kSevenStates> tangent{};
  for (std::size_t i = 0; i < kSevenStates; ++i) tangent[i][i] = 1.0;
  model.PropagateTangent(tangent_mean, tangent, in);
  EXPECT_NEAR(tangent_mean[kVelocity], x[kVelocity], 1e-14);
}

TEST(SevenStateModel, AllSigmaPointsMoveLikeSingleStates) {
  std::mt19937 random(8);
  using Points = SigmaPoints<kSevenStates>;
  for (const double exponent : {1.0, 2.0, 1.4}) {
    const SevenStateModel model(Nominal(exponent), 89.0, 1e-3, 0.2, 25e-9);
    for (int trial = 0; trial < 50; ++trial) {
      SqrtUkf<kSevenStates> filter;
      filter.x = RandomState(random, 1e-3);
      std::normal_distribution<double> normal;
      const X std{1e-8, 2e-4, 5.0, 2.0, 1.0, 1.0, 0.1};
      for (std::size_t i = 0; i < kSevenStates; ++i)
        for (std::size_t j = 0; j <= i; ++j) filter.s[i][j] = std[i] * normal(random);
      Points points;
      filter.Draw(points);
      std::array<X, Points::kStride> single;
      for (std::size_t c = 0; c < single.size(); ++c)
        for (std::size_t i = 0; i < kSevenStates; ++i) single[c][i] = points.row[i][c];
      const SevenStateInput in{{50.0, 55.0}, 1.02, 0.97, 2000.0};
      model.Propagate(points, in, model.TermsAt(filter.x[kVelocity]).low_speed);
      for (std::size_t c = 0; c < single.size(); ++c) {
        model.Propagate(single[c], in);
        for (std::size_t i = 0; i < kSevenStates; ++i)
          EXPECT_NEAR(points.row[i][c], single[c][i], 1e-13 * std::abs(single[c][i]) + 1e-12 * std[i])
              << c << " " << i;
      }
    }
  }
}

TEST(SevenStateModel, TangentIsTheDerivative) {
  for (const double exponent : {1.0, 2.0}) {
    const SevenStateModel model(Nominal(exponent), 89.0, 1e-3, 0.2, 25e-9);
    std::mt19937 random(6);
    const std::array<double, kSevenStates> delta{1e-7, 1e-9, 1e-4, 1e-4, 1e-4, 1e-4, 1e-6};
    for (int trial = 0; trial < 100; ++trial) {
      X x = RandomState(random, 5e-3);
      if (std::abs(x[kVelocity]) < 1.5e-3) x[kVelocity] = std::copysign(1.5e-3, x[kVelocity]);
      const SevenStateInput in{{50.0, 30.0}, 1.1, 0.93, 2500.0};
      X mean = x;
      SquareMatrix<kSevenStates> jacobian{};
      for (std::size_t i = 0; i < kSevenStates; ++i) jacobian[i][i] = 1.0;
      model.PropagateTangent(mean, jacobian, in);
      X expected = x;
      model.Propagate(expected, in);
      for (std::size_t i = 0; i < kSevenStates; ++i) {
        EXPECT_NEAR(mean[i], expected[i], 1e-12 + 1e-14 * std::abs(expected[i]));
      }
      for (std::size_t j = 0; j < kSevenStates; ++j) {
        X plus = x, minus = x;
        plus[j] += delta[j];
        minus[j] -= delta[j];
        model.Propagate(plus, in);
        model.Propagate(minus, in);
        for (std::size_t i = 0; i < kSevenStates; ++i) {
          const double difference = (plus[i] - minus[i]) / (2.0 * delta[j]);
          // Scaled to what one step of each state means in the filter.
          const double unit = delta[j] / delta[i];
          EXPECT_NEAR(jacobian[i][j] * unit, difference * unit, 1e-4 * (1.0 + std::abs(difference * unit)))
              << i << "," << j << " trial " << trial;
        }
      }
    }
  }
}

TEST(SevenStateModel, ABristleBeyondItsLevelLetsGoAtOnce) {
  // The level fell from 40 N to almost nothing: within a millisecond of motion nothing may be left of it,
  // however soft the screw is.
  const SevenStateModel model(Nominal(), 90.0, 1e-3, 0.2, 1e-7);
  StateVector<kSevenStates> x{};
  x[kVelocity] = 1e-3;
  x[kBristle] = 40.0;
  x[kLevelPlus] = x[kLevelMinus] = 0.01;
  model.Propagate(x, {{}, 1.0, 1.0});
  EXPECT_NEAR(x[kBristle], 0.0, 0.1);
}

TEST(SevenStateModel, LevelNeverReachesZero) {
  const SevenStateModel model(Nominal(), 89.0, 1e-3, 0.2);
  X x{};
  x[kVelocity] = 1e-3;
  x[kLevelPlus] = -5.0;
  x[kBristle] = 10.0;
  EXPECT_GE(model.Level(x, model.TermsAt(x[kVelocity]), {}), kLeastLevel_N);
  model.Propagate(x, {});
  for (const double v : x) EXPECT_TRUE(std::isfinite(v));
}

}  // namespace
}  // namespace contour
