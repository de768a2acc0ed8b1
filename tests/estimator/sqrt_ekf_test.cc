#include "estimator/sqrt_ekf.h"

#include <gtest/gtest.h>

#include "tests/estimator/dense_filter.h"

namespace contour {
namespace {

TEST(SqrtEkf, MatchesADenseKalmanFilterOnALinearModel) {
  SqrtEkf<3> fast;
  test::DenseFilter<3> dense;
  const std::array<double, 3> start{0.1, 0.2, 0.3};
  for (std::size_t i = 0; i < 3; ++i) {
    fast.s[i][i] = start[i];
    dense.p[i][i] = static_cast<long double>(start[i]) * start[i];
  }
  const double a[3][3] = {{1.0, 0.1, 0.005}, {0.0, 0.95, 0.1}, {0.0, -0.02, 0.99}};
  const std::array<double, 3> noise{0.0, 1e-3, 1e-2};
  for (int k = 0; k < 200; ++k) {
    fast.Predict(
        [&](StateVector<3>& x, SquareMatrix<3>& t) noexcept {
          const auto x0 = x;
          const auto t0 = t;
          for (std::size_t i = 0; i < 3; ++i) {
            x[i] = 0.0;
            for (std::size_t c = 0; c < 3; ++c) t[i][c] = 0.0;
            for (std::size_t j = 0; j < 3; ++j) {
              x[i] += a[i][j] * x0[j];
              for (std::size_t c = 0; c < 3; ++c) t[i][c] += a[i][j] * t0[j][c];
            }
          }
        },
        noise);
    const auto x0 = dense.x;
    const auto p0 = dense.p;
    for (std::size_t i = 0; i < 3; ++i) {
      dense.x[i] = 0.0L;
      for (std::size_t j = 0; j < 3; ++j) dense.x[i] += a[i][j] * x0[j];
      for (std::size_t j = 0; j < 3; ++j) {
        dense.p[i][j] = i == j ? static_cast<long double>(noise[i]) * noise[i] : 0.0L;
        for (std::size_t m = 0; m < 3; ++m) {
          for (std::size_t n = 0; n < 3; ++n) dense.p[i][j] += a[i][m] * p0[m][n] * a[j][n];
        }
      }
    }
    Innovation innovation;
    const double y = std::sin(0.05 * k);
    fast.UpdateState0(y, 0.05, {1e9, 1e9}, AllStates<3>(), innovation);
    dense.UpdateState0(y, 0.05, {true, true, true});
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_NEAR(fast.x[i], static_cast<double>(dense.x[i]), 1e-12);
      ASSERT_NEAR(fast.Variance(i), static_cast<double>(dense.p[i][i]), 1e-14);
    }
  }
}

}  // namespace
}  // namespace contour
