#include "control/axis_dynamics.h"

#include <array>
#include <cmath>
#include <stdexcept>

namespace contour {
namespace {

using Matrix4 = std::array<std::array<double, 4>, 4>;

Matrix4 Product(const Matrix4& a, const Matrix4& b) {
  Matrix4 c{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = 0; k < 4; ++k) c[i][j] += a[i][k] * b[k][j];
    }
  }
  return c;
}

Matrix4 Identity() {
  Matrix4 m{};
  for (std::size_t i = 0; i < 4; ++i) m[i][i] = 1.0;
  return m;
}

// Matrix exponential by scaling and squaring of a Taylor series; the norm after scaling is below 1/16.
Matrix4 Exponential(Matrix4 a) {
  double norm = 0.0;
  for (const auto& row : a) {
    for (const double x : row) norm = std::max(norm, 4.0 * std::abs(x));
  }
  int squarings = 0;
  while (norm > 1.0 / 16.0) {
    norm /= 2.0;
    ++squarings;
  }
  for (auto& row : a) {
    for (double& x : row) x = std::ldexp(x, -squarings);
  }
  Matrix4 term = Identity();
  Matrix4 sum = Identity();
  for (int n = 1; n <= 14; ++n) {
    term = Product(term, a);
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        term[i][j] /= n;
        sum[i][j] += term[i][j];
      }
    }
  }
  for (int i = 0; i < squarings; ++i) sum = Product(sum, sum);
  return sum;
}

// Time in periods: position m, velocity m per period, lagged acceleration, commanded acceleration.
Matrix4 Generator(double period_s, double lag_s, double viscous_1_s) {
  const double rate = lag_s > 0.0 ? period_s / lag_s : 0.0;
  Matrix4 g{};
  g[0][1] = 1.0;
  g[1][1] = -viscous_1_s * period_s;
  g[1][2] = period_s * period_s;
  g[2][2] = -rate;
  g[2][3] = rate;
  return g;
}

}  // namespace

AxisDynamics DiscretizeAxis(double period_s, double lag_s, double viscous_1_s) {
  if (!(period_s > 0.0)) throw std::invalid_argument("axis dynamics: the period must be positive");
  if (!(lag_s >= 0.0)) throw std::invalid_argument("axis dynamics: the drive's lag must not be negative");
  if (!(viscous_1_s >= 0.0))
    throw std::invalid_argument("axis dynamics: viscous friction must not be negative");
  // A lag below a thousandth of the period moves nothing that a double-precision plant would notice.
  const double lag = lag_s < 1e-3 * period_s ? 0.0 : lag_s;
  const Matrix4 held = Exponential(Generator(period_s, 0.0, viscous_1_s));
  const Matrix4 e = Exponential(Generator(period_s, lag, viscous_1_s));
  AxisDynamics d;
  d.position_from_velocity = held[0][1] * period_s;
  d.velocity_kept = held[1][1];
  d.position_from_known = held[0][2];
  d.velocity_from_known = held[1][2] / period_s;
  if (lag > 0.0) {
    d.position_from_command = e[0][3];
    d.position_from_previous = e[0][2];
    d.velocity_from_command = e[1][3] / period_s;
    d.velocity_from_previous = e[1][2] / period_s;
  } else {
    d.position_from_command = d.position_from_known;
    d.velocity_from_command = d.velocity_from_known;
  }
  return d;
}

}  // namespace contour
