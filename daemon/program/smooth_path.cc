#include "daemon/program/smooth_path.h"

#include <algorithm>
#include <utility>

namespace contour {

SmoothPath::SmoothPath(std::vector<double> knots_m, std::vector<PerAxis<double>> coefficients_m)
    : knots_(std::move(knots_m)), coefficients_(std::move(coefficients_m)) {}

std::size_t SmoothPath::PieceAt(double way_m) const {
  const auto first = knots_.begin() + 4;
  const auto last = knots_.end() - 4;
  return static_cast<std::size_t>(std::upper_bound(first, last, way_m) - first);
}

SmoothPath SmoothPath::Between(std::size_t first_knot, std::size_t last_knot) const {
  const auto knot = [&](std::size_t i) { return knots_.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto coefficient = [&](std::size_t i) {
    return coefficients_.begin() + static_cast<std::ptrdiff_t>(i);
  };
  return {std::vector<double>(knot(first_knot - 3), knot(last_knot + 4)),
          std::vector<PerAxis<double>>(coefficient(first_knot - 3), coefficient(last_knot))};
}

PerAxis<double> SmoothPath::Position(double way_m) const { return At(way_m).position_m; }

PathDerivatives SmoothPath::At(double way_m, std::size_t piece) const {
  // De Boor's triangles of the spline and its derivatives. t[0..5] are the knots about the piece, which lies
  // between t[2] and t[3].
  const double* t = knots_.data() + piece + 1;
  const double x = way_m;
  const std::size_t n = axis_count();
  PathDerivatives out{PerAxis<double>(n), PerAxis<double>(n), PerAxis<double>(n), PerAxis<double>(n)};
  const double a1 = (x - t[0]) / (t[3] - t[0]), a2 = (x - t[1]) / (t[4] - t[1]),
               a3 = (x - t[2]) / (t[5] - t[2]);
  const double b1 = (x - t[1]) / (t[3] - t[1]), b2 = (x - t[2]) / (t[4] - t[2]);
  const double c1 = (x - t[2]) / (t[3] - t[2]);
  for (std::size_t i = 0; i < n; ++i) {
    const double q0 = coefficients_[piece][i], q1 = coefficients_[piece + 1][i],
                 q2 = coefficients_[piece + 2][i], q3 = coefficients_[piece + 3][i];
    const double p0 = q0 + a1 * (q1 - q0), p1 = q1 + a2 * (q2 - q1), p2 = q2 + a3 * (q3 - q2);
    const double r0 = p0 + b1 * (p1 - p0), r1 = p1 + b2 * (p2 - p1);
    out.position_m[i] = r0 + c1 * (r1 - r0);
    const double d0 = 3.0 * (q1 - q0) / (t[3] - t[0]), d1 = 3.0 * (q2 - q1) / (t[4] - t[1]),
                 d2 = 3.0 * (q3 - q2) / (t[5] - t[2]);
    const double e0 = d0 + b1 * (d1 - d0), e1 = d1 + b2 * (d2 - d1);
    out.first[i] = e0 + c1 * (e1 - e0);
    const double f0 = 2.0 * (d1 - d0) / (t[3] - t[1]), f1 = 2.0 * (d2 - d1) / (t[4] - t[2]);
    out.second[i] = f0 + c1 * (f1 - f0);
    out.third[i] = (f1 - f0) / (t[3] - t[2]);
  }
  return out;
}

}  // namespace contour
