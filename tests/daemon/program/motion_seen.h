#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "daemon/program/motion_plan.h"

namespace contour::testing {

/// What the points of a program ask of the axes: differences of positions from cycle to cycle, as shares of
/// the limits.
struct MotionSeen {
  double velocity = 0.0, acceleration = 0.0, jerk = 0.0;
  double off_path_m = 0.0;
  double mismatch_m_s = 0.0;  ///< stated velocity against positions
  double slowest_m_s = 1e9;   ///< not near start and end
  double fastest_m_s = 0.0;
  double duration_s = 0.0;
};

using PointAtTime = std::function<void(double, PerAxis<ReferencePoint>&)>;

inline MotionSeen SeeMotion(const PointAtTime& at, double duration_s, const MotionPlan& plan,
                            const PerAxis<PlanLimits>& limits, double step_s = 1e-3) {
  MotionSeen seen;
  seen.duration_s = duration_s;
  PerAxis<ReferencePoint> p;
  PerAxis<double> before[3];
  PerAxis<double> velocity_before;
  const auto count = static_cast<long>(duration_s / step_s) + 5;
  for (long k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) * step_s;
    at(t, p);
    PerAxis<double> q, v;
    double speed = 0.0;
    for (const ReferencePoint& r : p) {
      q.push_back(r.position_m);
      v.push_back(r.velocity_m_s);
      speed = std::hypot(speed, r.velocity_m_s);
    }
    seen.off_path_m = std::max(seen.off_path_m, plan.Distance_m(q));
    seen.fastest_m_s = std::max(seen.fastest_m_s, speed);
    if (t > 0.1 && t < duration_s - 0.1) seen.slowest_m_s = std::min(seen.slowest_m_s, speed);
    for (std::size_t i = 0; k >= 3 && i < q.size(); ++i) {
      const double d1 = (q[i] - before[0][i]) / step_s;
      const double d2 = (q[i] - 2 * before[0][i] + before[1][i]) / (step_s * step_s);
      const double d3 =
          (q[i] - 3 * before[0][i] + 3 * before[1][i] - before[2][i]) / (step_s * step_s * step_s);
      seen.velocity = std::max(seen.velocity, std::abs(d1) / limits[i].velocity_m_s);
      seen.acceleration = std::max(seen.acceleration, std::abs(d2) / limits[i].acceleration_m_s2);
      if (limits[i].jerk_m_s3 > 0.0) seen.jerk = std::max(seen.jerk, std::abs(d3) / limits[i].jerk_m_s3);
      seen.mismatch_m_s = std::max(seen.mismatch_m_s, std::abs(d1 - 0.5 * (v[i] + velocity_before[i])));
    }
    before[2] = before[1];
    before[1] = before[0];
    before[0] = q;
    velocity_before = v;
  }
  return seen;
}

inline MotionSeen SeeMotion(const MotionPlan& plan, const PerAxis<PlanLimits>& limits) {
  return SeeMotion([&](double t, PerAxis<ReferencePoint>& p) { plan.At(t, p); }, plan.duration_s(), plan,
                   limits);
}

}  // namespace contour::testing
