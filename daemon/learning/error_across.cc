#include "daemon/learning/error_across.h"

#include <algorithm>
#include <cmath>

namespace contour {
namespace {

/// Below this speed what is along the path and what is across fade into one.
constexpr double kRestSpeed_m_s = 0.05e-3;
/// A table that is later than this is lost rather than late.
constexpr double kLatest_s = 5e-3;
/// Newton steps to the nearest point; the first leaves a share of what the path bends while the table is
/// late.
constexpr int kSteps = 2;

/// By how much later the path is nearest, to first order.
double Later_s(const PerAxis<ReferencePoint>& path, const PerAxis<double>& table_m) {
  double along = 0.0, square = kRestSpeed_m_s * kRestSpeed_m_s;
  for (std::size_t i = 0; i < path.size(); ++i) {
    along += path[i].velocity_m_s * (table_m[i] - path[i].position_m);
    square += path[i].velocity_m_s * path[i].velocity_m_s;
  }
  return along / square;
}

}  // namespace

ErrorAcross FindErrorAcross(const MotionPlan& plan, const MeasuredPass& pass, const PathOffsets* followed,
                            double period_s) {
  const std::size_t axes = plan.axis_count();
  ErrorAcross out;
  out.error_m.assign(axes, std::vector<float>(pass.points(), 0.0F));
  PerAxis<ReferencePoint> path;
  PerAxis<double> table_m(axes);
  double late_s = 0.0, moving = 0.0;
  for (std::size_t k = 0; k < pass.points(); ++k) {
    if (!pass.seen(k)) continue;
    const double time_s = static_cast<double>(k) * period_s;
    plan.At(time_s, path);
    double speed = 0.0;
    for (std::size_t i = 0; i < axes; ++i) {
      const double shift_m = followed != nullptr ? followed->At(i, k) : 0.0;
      table_m[i] = path[i].position_m + shift_m - pass.behind_m(i, k);
      speed += path[i].velocity_m_s * path[i].velocity_m_s;
    }
    double nearest_s = time_s;
    for (int step = 0; step < kSteps; ++step) {
      nearest_s = std::clamp(nearest_s + Later_s(path, table_m), time_s - kLatest_s, time_s + kLatest_s);
      plan.At(nearest_s, path);
    }
    if (speed > kRestSpeed_m_s * kRestSpeed_m_s) {
      late_s += time_s - nearest_s;
      moving += 1.0;
    }
    for (std::size_t i = 0; i < axes; ++i)
      out.error_m[i][k] = static_cast<float>(path[i].position_m - table_m[i]);
  }
  if (moving > 0.0) out.late_s = late_s / moving;
  return out;
}

}  // namespace contour
