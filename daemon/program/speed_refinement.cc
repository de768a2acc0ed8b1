#include "daemon/program/speed_refinement.h"

#include <algorithm>
#include <cmath>

#include "daemon/program/speed_grid.h"

namespace contour {
namespace {

// An interval may take so much longer than a step should, and is divided by no more at once.
constexpr double kLonger = 1.5;
constexpr int kMostParts = 16;
// Of the distance between a grid's nodes: one that is there already may be so near.
constexpr double kNear = 0.4;

}  // namespace

void RefineForChange(const Stretch& stretch, const RestMap& map, std::size_t node, std::size_t nodes,
                     double slow_m_s, SpeedSpline& speed) {
  const std::size_t end = node + nodes;
  for (std::size_t i = node; i < end && i + 1 < speed.u.size();) {
    const double middle = 0.5 * (speed.u[i] + speed.u[i + 1]);
    const RestMap::Derivatives s = map.At(middle);
    const double squared = 0.5 * (speed.Value(i) + speed.Value(i + 1));
    const double speed_m_s = s.first * std::sqrt(squared);
    if (speed_m_s < slow_m_s) return;
    const double width = speed.width(i);
    const double time_s = width / std::sqrt(squared);
    const double step_s = StepTime_s(stretch, s.way_m, speed_m_s);
    int parts = 1;
    if (time_s > kLonger * step_s)
      parts = static_cast<int>(std::min(static_cast<double>(kMostParts), std::ceil(time_s / step_s)));
    const double from = speed.u[i];
    for (int k = 1; k < parts; ++k)
      speed.Insert(i + static_cast<std::size_t>(k) - 1, from + width * k / parts);
    i += static_cast<std::size_t>(parts);
  }
}

void RefineByGrid(const std::vector<double>& grid, std::size_t node, std::size_t nodes, SpeedSpline& speed) {
  const std::size_t end = node + nodes;
  std::size_t i = node;
  auto wanted = std::upper_bound(grid.begin(), grid.end(), speed.u[node]);
  for (; wanted != grid.end() && wanted + 1 != grid.end(); ++wanted) {
    while (i + 2 < speed.u.size() && speed.u[i + 1] <= *wanted) ++i;
    if (i >= end) return;
    const double before = wanted == grid.begin() ? *(wanted + 1) - *wanted : *wanted - *(wanted - 1);
    const double near = kNear * std::min(before, *(wanted + 1) - *wanted);
    if (*wanted - speed.u[i] > near && speed.u[i + 1] - *wanted > near) speed.Insert(i, *wanted);
  }
}

}  // namespace contour
