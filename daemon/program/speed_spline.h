#pragma once

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
};

/// Weights of an interval's three coefficients in something linear.
using SpeedWeights = std::array<double, 3>;

/// Of value and slope at begin, middle and end of an interval, and of the second derivative within it.
struct IntervalWeights {
  std::array<SpeedWeights, 3> value, slope;
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
  w.value[1] = w.ValueAt(0.5 * h);
  for (std::size_t k = 0; k < 3; ++k) w.slope[1][k] = w.slope[0][k] + 0.5 * h * w.bend[k];
  w.value[2] = {0.0, b, 1.0 - b};
  w.slope[2] = {0.0, -e, e};
  return w;
}

}  // namespace contour
