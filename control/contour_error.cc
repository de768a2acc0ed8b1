#include "control/contour_error.h"

#include <algorithm>
#include <cmath>

#include "control/contour_path.h"
#include "core/wide_vectors.h"

namespace contour {
namespace {

constexpr double kFarthestPeriods = 16.0;
constexpr int kNewtonSteps = 5;
// Nearer to the foot the distance does not change any more: it grows with the square.
constexpr double kThere_periods = 1e-6;

double Distance2(const PerAxis<double>& position_m, const PathSample& sample) noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < position_m.size(); ++i) {
    const double e = position_m[i] - sample.position_m[i];
    sum += e * e;
  }
  return sum;
}

// Newton step towards the foot of the perpendicular; along the path alone where its bend misleads.
double StepToFoot(const PerAxis<double>& position_m, const PathSample& sample, double period_s) noexcept {
  double ev = 0.0, ea = 0.0, vv = 0.0;
  for (std::size_t i = 0; i < position_m.size(); ++i) {
    const double e = position_m[i] - sample.position_m[i];
    const double v = sample.velocity_m_s[i];
    ev += e * v;
    ea += e * sample.acceleration_m_s2[i];
    vv += v * v;
  }
  const double curvature = vv - ea > 0.25 * vv ? vv - ea : vv;
  return curvature > 0.0 ? ev / (curvature * period_s) : 0.0;
}

bool StandsStill(const PerAxis<AxisHorizon>& reference) noexcept {
  for (const AxisHorizon& axis : reference) {
    const double here_m = axis[0].position_m;
    for (const ReferencePoint& point : axis)
      if (point.position_m != here_m || point.velocity_m_s != 0.0 || point.acceleration_m_s2 != 0.0)
        return false;
  }
  return true;
}

}  // namespace

CONTOUR_WIDE_VECTORS
ContourError FindContourError(const PerAxis<double>& position_m, const PerAxis<AxisHorizon>& reference,
                              double period_s, std::size_t now) noexcept {
  ContourError error;
  const ContourPath path(reference, period_s);
  const double origin = static_cast<double>(now);
  PathSample sample;
  path.At(origin, sample);
  double best = Distance2(position_m, sample);
  double best_at = origin;
  double speed2 = 0.0;
  for (std::size_t i = 0; i < position_m.size(); ++i) {
    error.lag_m += (sample.position_m[i] - position_m[i]) * sample.velocity_m_s[i];
    speed2 += sample.velocity_m_s[i] * sample.velocity_m_s[i];
  }
  const double speed = std::sqrt(speed2);
  error.lag_m = speed > 0.0 ? error.lag_m / speed : 0.0;

  if (speed == 0.0 && StandsStill(reference)) {
    error.contour_m = std::sqrt(best);
    return error;
  }

  // The nearest point is no farther than the reference: twice the time to it, for paths that slow down
  // nearby.
  const double reach =
      std::min(kFarthestPeriods, std::ceil(2.0 * std::sqrt(best) / std::max(speed * period_s, 1e-12)));
  const double from = origin - reach;
  const double to = std::min(origin + reach, path.end());
  bool sampled_origin = true;
  for (double at = from; at <= to; at += 1.0) {
    if (at == origin) continue;
    double distance2 = 0.0;
    if (at >= 0.0) {
      distance2 = path.Distance2(position_m, static_cast<std::size_t>(at));
    } else {
      path.At(at, sample);
      sampled_origin = false;
      distance2 = Distance2(position_m, sample);
    }
    if (distance2 < best) {
      best = distance2;
      best_at = at;
    }
  }
  double at = best_at;
  if (at != origin || !sampled_origin) path.At(at, sample);
  for (int i = 0; i < kNewtonSteps; ++i) {
    const double before = at;
    at = std::clamp(at + StepToFoot(position_m, sample, period_s), std::min(from, best_at),
                    std::max(to, best_at));
    if (at == before) break;
    path.At(at, sample);
    const bool there = std::abs(at - before) < kThere_periods;
    const double distance2 = Distance2(position_m, sample);
    if (distance2 <= best) {
      best = distance2;
      best_at = at;
    }
    if (there) break;
  }
  error.contour_m = std::sqrt(best);
  error.nearest_periods = best_at - origin;
  return error;
}

}  // namespace contour
