#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace contour {

/// The square of a parameter's speed as a quadratic spline over nodes: with n nodes n + 1 coefficients; those
/// of interval i are i, i + 1 and i + 2. As every one of them is positive, so is the spline.
struct SpeedSpline {
  std::vector<double> u;     ///< nodes, rising
  std::vector<double> beta;  ///< coefficients

  [[nodiscard]] double width(std::size_t i) const { return u[i + 1] - u[i]; }
  [[nodiscard]] double before(std::size_t node) const { return node == 0 ? 0.0 : u[node] - u[node - 1]; }
  [[nodiscard]] double after(std::size_t node) const {
    return node + 1 == u.size() ? 0.0 : u[node + 1] - u[node];
  }
  /// Of coefficient `node` in the value there; the rest is of the next one.
  [[nodiscard]] double Share(std::size_t node) const { return after(node) / (before(node) + after(node)); }
  /// Slope at a node for a difference of one between its two coefficients.
  [[nodiscard]] double SlopeOf(std::size_t node) const { return 2.0 / (before(node) + after(node)); }

  [[nodiscard]] double Value(std::size_t node) const {
    const double share = Share(node);
    return share * beta[node] + (1.0 - share) * beta[node + 1];
  }
  [[nodiscard]] double Slope(std::size_t node) const { return SlopeOf(node) * (beta[node + 1] - beta[node]); }
  /// Second derivative within an interval.
  [[nodiscard]] double Bend(std::size_t i) const { return (Slope(i + 1) - Slope(i)) / width(i); }

  /// Another node within interval i; the spline stays what it is.
  void Insert(std::size_t i, double at_u) {
    const double a = (at_u - u[i == 0 ? 0 : i - 1]) / (u[i + 1] - u[i == 0 ? 0 : i - 1]);
    const double b = (at_u - u[i]) / (u[std::min(i + 2, u.size() - 1)] - u[i]);
    const double left = (1.0 - a) * beta[i] + a * beta[i + 1];
    const double right = (1.0 - b) * beta[i + 1] + b * beta[i + 2];
    beta[i + 1] = left;
    beta.insert(beta.begin() + static_cast<std::ptrdiff_t>(i) + 2, right);
    u.insert(u.begin() + static_cast<std::ptrdiff_t>(i) + 1, at_u);
  }
};

/// Weights of an interval's three coefficients in something linear.
using SpeedWeights = std::array<double, 3>;

/// Places of an interval that are looked at, from its begin to its end.
inline constexpr std::size_t kSpeedPlaces = 5;

/// Of value and slope at these places, and of the second derivative within the interval.
struct IntervalWeights {
  std::array<SpeedWeights, kSpeedPlaces> value, slope;
  SpeedWeights bend;

  [[nodiscard]] SpeedWeights ValueAt(double since_u) const {
    SpeedWeights g;
    for (std::size_t k = 0; k < 3; ++k)
      g[k] = value[0][k] + since_u * (slope[0][k] + 0.5 * since_u * bend[k]);
    return g;
  }
};

inline IntervalWeights WeightsOf(const SpeedSpline& s, std::size_t i) {
  const double a = s.Share(i), b = s.Share(i + 1), d = s.SlopeOf(i), e = s.SlopeOf(i + 1), h = s.width(i);
  IntervalWeights w;
  w.bend = {d / h, -(d + e) / h, e / h};
  w.value[0] = {a, 1.0 - a, 0.0};
  w.slope[0] = {-d, d, 0.0};
  for (std::size_t m = 1; m + 1 < kSpeedPlaces; ++m) {
    const double since = h * static_cast<double>(m) / (kSpeedPlaces - 1);
    w.value[m] = w.ValueAt(since);
    for (std::size_t k = 0; k < 3; ++k) w.slope[m][k] = w.slope[0][k] + since * w.bend[k];
  }
  w.value[kSpeedPlaces - 1] = {0.0, b, 1.0 - b};
  w.slope[kSpeedPlaces - 1] = {0.0, -e, e};
  return w;
}

}  // namespace contour
