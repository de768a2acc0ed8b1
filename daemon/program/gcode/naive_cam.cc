#include "daemon/program/gcode/naive_cam.h"

#include <algorithm>
#include <cmath>

namespace contour {
namespace {

// LinuxCNC looks at no more points.
constexpr std::size_t kMostPoints = 101;
constexpr std::size_t kTool = 3;  // X Y Z

double DistanceToLine_m(const AxisValues& point, const AxisValues& from, const AxisValues& to) {
  double along = 0.0, squared = 0.0;
  for (std::size_t k = 0; k < kTool; ++k) {
    along += (point[k] - from[k]) * (to[k] - from[k]);
    squared += (to[k] - from[k]) * (to[k] - from[k]);
  }
  const double share = squared > 0.0 ? std::clamp(along / squared, 0.0, 1.0) : 0.0;
  double off = 0.0;
  for (std::size_t k = 0; k < kTool; ++k)
    off = std::hypot(off, point[k] - from[k] - share * (to[k] - from[k]));
  return off;
}

bool AlongTheTool(const AxisValues& from_m, const AxisValues& to_m) {
  return std::equal(from_m.begin() + kTool, from_m.end(), to_m.begin() + kTool);
}

bool Blends(const GcodeMove& move) {
  return move.corner == GcodeMove::Corner::kBlended || move.corner == GcodeMove::Corner::kContinuous;
}

}  // namespace

bool NaiveCam::Fits(const AxisValues& end_m, double within_m) const {
  // A way back to its begin would be no line.
  if (points_m_.size() >= kMostPoints || std::equal(end_m.begin(), end_m.begin() + kTool, begin_m_.begin()))
    return false;
  return std::all_of(points_m_.begin(), points_m_.end(),
                     [&](const AxisValues& p) { return DistanceToLine_m(p, begin_m_, end_m) <= within_m; });
}

bool NaiveCam::Joins(const AxisValues& from_m, const GcodeMove& move, double within_m) {
  const bool may = move.kind == GcodeMove::Kind::kLine && Blends(move) && within_m > 0.0 &&
                   AlongTheTool(from_m, move.target_m);
  if (!may) {
    Break();
    return false;
  }
  const bool joins = !points_m_.empty() && newest_.feed_m_s == move.feed_m_s &&
                     newest_.corner == move.corner && newest_.tolerance_m == move.tolerance_m &&
                     Fits(move.target_m, within_m);
  if (!joins) {
    points_m_.clear();
    begin_m_ = from_m;
  }
  points_m_.push_back(move.target_m);
  newest_ = move;
  return joins;
}

}  // namespace contour
