#include "control/contour_path.h"

#include <algorithm>
#include <cmath>

#include "core/wide_vectors.h"

namespace contour {
namespace {

struct Scalars {
  double position_m, velocity_m_s, acceleration_m_s2;
};

Scalars Parabola(const ReferencePoint& point, double time_s) noexcept {
  return {point.position_m + time_s * (point.velocity_m_s + 0.5 * time_s * point.acceleration_m_s2),
          point.velocity_m_s + time_s * point.acceleration_m_s2, point.acceleration_m_s2};
}

// Cubic with the positions and velocities of both ends; x in [0, 1].
Scalars Hermite(const ReferencePoint& a, const ReferencePoint& b, double x, double period_s) noexcept {
  const double rise = b.position_m - a.position_m;
  const double va = a.velocity_m_s * period_s, vb = b.velocity_m_s * period_s;
  const double c2 = 3.0 * rise - 2.0 * va - vb;
  const double c3 = va + vb - 2.0 * rise;
  return {a.position_m + x * (va + x * (c2 + x * c3)), (va + x * (2.0 * c2 + x * 3.0 * c3)) / period_s,
          (2.0 * c2 + 6.0 * c3 * x) / (period_s * period_s)};
}

}  // namespace

ContourPath::ContourPath(const PerAxis<AxisHorizon>& reference, double period_s) noexcept
    : reference_(&reference), points_(reference.empty() ? 1 : reference[0].size()), period_s_(period_s) {
  for (const AxisHorizon& axis : reference) points_ = std::min(points_, axis.size());
}

CONTOUR_WIDE_VECTORS
void ContourPath::At(double periods, PathSample& sample) const noexcept {
  const std::size_t axes = reference_->size();
  sample.position_m.resize(axes);
  sample.velocity_m_s.resize(axes);
  sample.acceleration_m_s2.resize(axes);
  const std::size_t last = points_ - 1;
  for (std::size_t i = 0; i < axes; ++i) {
    const AxisHorizon& points = (*reference_)[i];
    Scalars s{};
    if (periods <= 0.0) {
      s = Parabola(points[0], periods * period_s_);
    } else if (periods >= static_cast<double>(last)) {
      s = Parabola(points[last], (periods - static_cast<double>(last)) * period_s_);
    } else {
      const auto j = static_cast<std::size_t>(periods);
      s = Hermite(points[j], points[j + 1], periods - static_cast<double>(j), period_s_);
    }
    sample.position_m[i] = s.position_m;
    sample.velocity_m_s[i] = s.velocity_m_s;
    sample.acceleration_m_s2[i] = s.acceleration_m_s2;
  }
}

bool ContourPath::Tangent(const PathSample& sample, PerAxis<double>& tangent) noexcept {
  tangent = sample.velocity_m_s;
  double square = 0.0;
  for (const double v : tangent) square += v * v;
  const bool moves = square > 0.0;
  const double scale = moves ? 1.0 / std::sqrt(square) : 0.0;
  for (double& t : tangent) t *= scale;
  return moves;
}

double ContourPath::Curvature_1_m(const PathSample& sample) noexcept {
  double vv = 0.0, va = 0.0, aa = 0.0;
  for (std::size_t i = 0; i < sample.velocity_m_s.size(); ++i) {
    const double v = sample.velocity_m_s[i], a = sample.acceleration_m_s2[i];
    vv += v * v;
    va += v * a;
    aa += a * a;
  }
  if (!(vv > 0.0)) return 0.0;
  return std::sqrt(std::max(0.0, vv * aa - va * va)) / (vv * std::sqrt(vv));
}

}  // namespace contour
