#include "tools/faults/test_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace contour::faults {

TestPlan::TestPlan(TestPath path, double period_s) : period_s_(period_s) {
  for (PathPoint point; path.Next(point);) points_.push_back(point.axes);
}

// Quintic: position, velocity and acceleration meet the points.
void TestPlan::At(double time_s, PerAxis<ReferencePoint>& axes) const {
  const double h = period_s_;
  const double place = std::clamp(time_s / h, 0.0, static_cast<double>(points_.size() - 1));
  const std::size_t index = std::min(static_cast<std::size_t>(place), points_.size() - 2);
  const double s = place - static_cast<double>(index);
  axes.resize(axis_count());
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const ReferencePoint& a = points_[index][i];
    const ReferencePoint& b = points_[index + 1][i];
    const double v0 = a.velocity_m_s * h, v1 = b.velocity_m_s * h;
    const double a0 = a.acceleration_m_s2 * h * h, a1 = b.acceleration_m_s2 * h * h;
    const double d = b.position_m - a.position_m;
    const double c3 = 10 * d - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1;
    const double c4 = -15 * d + 8 * v0 + 7 * v1 + 1.5 * a0 - a1;
    const double c5 = 6 * d - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1;
    axes[i] = {a.position_m + s * (v0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5)))),
               (v0 + s * (a0 + s * (3 * c3 + s * (4 * c4 + s * 5 * c5)))) / h,
               (a0 + s * (6 * c3 + s * (12 * c4 + s * 20 * c5))) / (h * h)};
  }
}

}  // namespace contour::faults
