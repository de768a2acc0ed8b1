#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>

/// Textbook filters on full covariances in long double: slow, plain, and written without a look at the fast
/// ones.
namespace contour::test {

template <std::size_t N>
struct DenseFilter {
  using Real = long double;
  using Vector = std::array<Real, N>;
  using Matrix = std::array<std::array<Real, N>, N>;

  Vector x{};
  Matrix p{};

  /// Lower Cholesky factor; a zero pivot (within rounding) leaves a zero column.
  static Matrix Cholesky(const Matrix& p) {
    Matrix l{};
    for (std::size_t j = 0; j < N; ++j) {
      Real d = p[j][j];
      for (std::size_t k = 0; k < j; ++k) d -= l[j][k] * l[j][k];
      if (d <= 1e-17L * p[j][j]) continue;
      l[j][j] = std::sqrt(d);
      for (std::size_t i = j + 1; i < N; ++i) {
        Real v = p[i][j];
        for (std::size_t k = 0; k < j; ++k) v -= l[i][k] * l[j][k];
        l[i][j] = v / l[j][j];
      }
    }
    return l;
  }

  struct Points {
    std::array<Vector, 2 * N + 1> at;
    std::array<Real, 2 * N + 1> mean_weight;
    std::array<Real, 2 * N + 1> covariance_weight;
  };

  [[nodiscard]] Points Draw(Real alpha, Real beta, Real kappa) const {
    const auto n = static_cast<Real>(N);
    const Real lambda = alpha * alpha * (n + kappa) - n;
    const Matrix l = Cholesky(p);
    Points s;
    s.at.fill(x);
    s.mean_weight.fill(1.0L / (2.0L * (n + lambda)));
    s.covariance_weight = s.mean_weight;
    s.mean_weight[0] = lambda / (n + lambda);
    s.covariance_weight[0] = s.mean_weight[0] + 1.0L - alpha * alpha + beta;
    for (std::size_t j = 0; j < N; ++j) {
      for (std::size_t i = 0; i < N; ++i) {
        const Real d = std::sqrt(n + lambda) * l[i][j];
        s.at[1 + j][i] += d;
        s.at[1 + N + j][i] -= d;
      }
    }
    return s;
  }

  template <class Process>
  void UnscentedPredict(Process&& f, const Vector& noise, Real alpha, Real beta, Real kappa) {
    Points s = Draw(alpha, beta, kappa);
    for (auto& point : s.at) point = f(point);
    x = {};
    for (std::size_t k = 0; k < s.at.size(); ++k) {
      for (std::size_t i = 0; i < N; ++i) x[i] += s.mean_weight[k] * s.at[k][i];
    }
    p = {};
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j < N; ++j) {
        for (std::size_t k = 0; k < s.at.size(); ++k) {
          p[i][j] += s.covariance_weight[k] * (s.at[k][i] - x[i]) * (s.at[k][j] - x[j]);
        }
      }
      p[i][i] += noise[i] * noise[i];
    }
  }

  template <class Measure>
  void UnscentedUpdate(Measure&& h, Real y, Real r, Real alpha, Real beta, Real kappa) {
    const Points s = Draw(alpha, beta, kappa);
    Real mean = 0.0L;
    for (std::size_t k = 0; k < s.at.size(); ++k) mean += s.mean_weight[k] * h(s.at[k]);
    Real pyy = r * r;
    Vector pxy{};
    for (std::size_t k = 0; k < s.at.size(); ++k) {
      const Real dy = h(s.at[k]) - mean;
      pyy += s.covariance_weight[k] * dy * dy;
      for (std::size_t i = 0; i < N; ++i) pxy[i] += s.covariance_weight[k] * (s.at[k][i] - x[i]) * dy;
    }
    for (std::size_t i = 0; i < N; ++i) {
      x[i] += pxy[i] / pyy * (y - mean);
      for (std::size_t j = 0; j < N; ++j) p[i][j] -= pxy[i] * pxy[j] / pyy;
    }
  }

  /// y = x0 + noise; the gain of states not in `keep_moving` is zero (Joseph form).
  void UpdateState0(Real y, Real r, const std::array<bool, N>& moves) {
    const Real pyy = p[0][0] + r * r;
    Vector k{};
    for (std::size_t i = 0; i < N; ++i) k[i] = moves[i] ? p[i][0] / pyy : 0.0L;
    const Real innovation = y - x[0];
    const Matrix old = p;
    for (std::size_t i = 0; i < N; ++i) {
      x[i] += k[i] * innovation;
      for (std::size_t j = 0; j < N; ++j) {
        p[i][j] = old[i][j] - k[i] * old[0][j] - k[j] * old[i][0] + k[i] * k[j] * pyy;
      }
    }
  }
};

}  // namespace contour::test
