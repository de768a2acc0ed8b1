#include "estimator/sqrt_ukf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/estimator/dense_filter.h"

namespace contour {
namespace {

constexpr InnovationGate kOpen{1e12, 1e12};

// A pendulum with unknown damping and stiffness: curved enough that a wrong weight shows.
template <class Real>
std::array<Real, 4> Pendulum(const std::array<Real, 4>& x) {
  const Real h = static_cast<Real>(0.1L);
  return {x[0] + h * x[1], x[1] - h * (x[3] * std::sin(x[0]) + x[2] * x[1] * std::abs(x[1])), x[2], x[3]};
}

template <class Real>
Real Height(const std::array<Real, 4>& x) {
  return 1 - std::cos(x[0]) + static_cast<Real>(0.1L) * x[2] * x[3];
}

struct UnitSpread : DefaultSpread {
  static constexpr double kBeta = 0.0;
};
struct WideSpread {
  static constexpr double kAlpha = 1.0;
  static constexpr double kBeta = 1.5;
  static constexpr double kKappa = 1.0;
};

template <class Spread>
void CompareWithDense(bool nonlinear_measurement, double noise_scale) {
  SqrtUkf<4, Spread> fast;
  test::DenseFilter<4> dense;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::array<double, 4> truth{1.0, 0.0, 0.3, 4.0};
  fast.x = {0.8, 0.1, 0.2, 4.5};
  const std::array<double, 4> start{0.3, 0.4, 0.15, 0.5};
  const std::array<double, 4> noise{1e-3 * noise_scale, 1e-2 * noise_scale, 1e-3 * noise_scale,
                                    5e-3 * noise_scale};
  test::DenseFilter<4>::Vector dense_noise{};
  for (std::size_t i = 0; i < 4; ++i) {
    fast.s[i][i] = start[i];
    dense.x[i] = fast.x[i];
    dense.p[i][i] = static_cast<long double>(start[i]) * start[i];
    dense_noise[i] = noise[i];
  }
  for (int k = 0; k < 300; ++k) {
    truth = Pendulum(truth);
    fast.Predict(
        [](SigmaPoints<4>& points) noexcept {
          for (std::size_t c = 0; c < SigmaPoints<4>::kStride; ++c) {
            const auto next =
                Pendulum<double>({points.row[0][c], points.row[1][c], points.row[2][c], points.row[3][c]});
            for (std::size_t i = 0; i < 4; ++i) points.row[i][c] = next[i];
          }
        },
        noise);
    dense.UnscentedPredict(Pendulum<long double>, dense_noise, Spread::kAlpha, Spread::kBeta, Spread::kKappa);

    Innovation innovation;
    const double r = 0.02;
    if (nonlinear_measurement) {
      const double y = Height(truth) + r * normal(random);
      fast.Update(
          [](const SigmaPoints<4>& points, SigmaPoints<4>::Row& row) noexcept {
            for (std::size_t c = 0; c < SigmaPoints<4>::kStride; ++c) {
              row[c] =
                  Height<double>({points.row[0][c], points.row[1][c], points.row[2][c], points.row[3][c]});
            }
          },
          y, r, kOpen, innovation);
      dense.UnscentedUpdate(Height<long double>, y, r, Spread::kAlpha, Spread::kBeta, Spread::kKappa);
    } else {
      const double y = truth[0] + r * normal(random);
      fast.UpdateState0(y, r, kOpen, AllStates<4>(), innovation);
      dense.UpdateState0(y, r, {true, true, true, true});
    }
    for (std::size_t i = 0; i < 4; ++i) {
      ASSERT_NEAR(fast.x[i], static_cast<double>(dense.x[i]), 1e-9) << "step " << k << " state " << i;
      ASSERT_NEAR(std::sqrt(fast.Variance(i)), static_cast<double>(std::sqrt(dense.p[i][i])), 1e-9)
          << "step " << k << " state " << i;
      for (std::size_t j = 0; j < i; ++j) {
        double pij = 0.0;
        for (std::size_t c = 0; c < 4; ++c) pij += fast.s[i][c] * fast.s[j][c];
        ASSERT_NEAR(pij, static_cast<double>(dense.p[i][j]), 1e-9) << "step " << k << " " << i << "," << j;
      }
    }
  }
  EXPECT_NEAR(fast.x[0], truth[0], 0.2);
}

TEST(SqrtUkf, MatchesADenseUkfStepByStep) { CompareWithDense<DefaultSpread>(false, 1.0); }
TEST(SqrtUkf, MatchesADenseUkfWithANonlinearMeasurement) { CompareWithDense<DefaultSpread>(true, 1.0); }
TEST(SqrtUkf, MatchesWithNoCentreWeight) { CompareWithDense<UnitSpread>(true, 1.0); }
TEST(SqrtUkf, MatchesWithOtherWeights) { CompareWithDense<WideSpread>(true, 1.0); }
TEST(SqrtUkf, MatchesWithoutProcessNoise) { CompareWithDense<DefaultSpread>(false, 0.0); }

TEST(SqrtUkf, TheScalarUpdateIsTheGeneralOneForALinearMeasurement) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 50; ++trial) {
    SqrtUkf<4> a;
    for (std::size_t i = 0; i < 4; ++i) {
      a.x[i] = normal(random);
      for (std::size_t j = 0; j <= i; ++j) a.s[i][j] = normal(random);
      a.s[i][i] = std::abs(a.s[i][i]) + 0.1;
    }
    SqrtUkf<4> b = a;
    Innovation ia, ib;
    a.UpdateState0(0.4, 0.2, kOpen, AllStates<4>(), ia);
    b.Update([](const SigmaPoints<4>& points, SigmaPoints<4>::Row& row) noexcept { row = points.row[0]; },
             0.4, 0.2, kOpen, ib);
    EXPECT_NEAR(ia.std, ib.std, 1e-12);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(a.x[i], b.x[i], 1e-12);
      for (std::size_t j = 0; j <= i; ++j) EXPECT_NEAR(std::abs(a.s[i][j]), std::abs(b.s[i][j]), 1e-12);
    }
  }
}

TEST(SqrtUkf, TheGateKeepsAnAbsurdMeasurementOut) {
  SqrtUkf<2> f;
  f.x = {1.0, 2.0};
  f.s = {{{0.1, 0.0}, {0.0, 0.1}}};
  const auto before = f;
  Innovation innovation;
  const auto measure = [](const SigmaPoints<2>& points, SigmaPoints<2>::Row& row) noexcept {
    row = points.row[0];
  };
  EXPECT_EQ(f.Update(measure, 1e6, 0.1, {8.0, 0.0}, innovation), UpdateResult::kGated);
  EXPECT_EQ(f.x, before.x);
  EXPECT_EQ(f.s, before.s);
  EXPECT_EQ(f.Update(measure, 1.2, 0.1, {8.0, 0.0}, innovation), UpdateResult::kOk);
  EXPECT_NE(f.x, before.x);
}

TEST(SqrtUkf, ALargeOffsetCostsNoAccuracy) {
  // The same filter at 0 and at 1e4 (an angle after many turns).
  SqrtUkf<2> near, far;
  near.s = far.s = {{{1e-6, 0.0}, {0.0, 1e-3}}};
  far.x[0] = 1e4;
  const auto move = [](SigmaPoints<2>& points) noexcept {
    for (std::size_t c = 0; c < SigmaPoints<2>::kStride; ++c) points.row[0][c] += 1e-3 * points.row[1][c];
  };
  Innovation innovation;
  for (int k = 0; k < 2000; ++k) {
    const double y = 1e-5 * std::sin(0.01 * k);
    near.Predict(move, {1e-9, 1e-5});
    far.Predict(move, {1e-9, 1e-5});
    near.UpdateState0(y, 1e-8, kOpen, AllStates<2>(), innovation);
    far.UpdateState0(1e4 + y, 1e-8, kOpen, AllStates<2>(), innovation);
    ASSERT_NEAR(near.x[1], far.x[1], 1e-7) << k;  // 1e4 has a rounding of 2e-12, over one step of 1e-3
  }
}

}  // namespace
}  // namespace contour
