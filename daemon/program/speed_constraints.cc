#include "daemon/program/speed_constraints.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contour {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// Of the limits: between the places where they are kept exactly they may be missed by a little.
constexpr double kUsed = 0.995;
constexpr double kJerkUsed = 0.97;
// The constant speed to start from, of the largest one.
constexpr double kFloorShare = 0.3;

double Squared(double x) { return x * x; }

/// Caps by the axes' velocity and the feed of the move to one side of the node.
void LimitSpeed(const Stretch& stretch, const SpeedGoal& goal, double feed_m_s,
                SpeedConstraints::Place& node) {
  double squared = 0.0;
  double axes = kInfinite;
  for (std::size_t i = 0; i < stretch.limits().size(); ++i) {
    squared += Squared(node.first[i]);
    axes = std::min(axes, Squared(stretch.limits()[i].velocity_m_s / node.first[i]));
  }
  node.cap = std::min(node.cap, axes);
  // A rapid has no feed of its own: scaled down, it is a share of what the axes allow.
  const double scale = goal.feed_scale;
  const double feed =
      feed_m_s > 0.0 ? Squared(scale * feed_m_s) / squared : axes * Squared(std::min(1.0, scale));
  double& cap = goal.feed_may_exceed ? node.feed_cap : node.cap;
  cap = std::min(cap, feed);
}

}  // namespace

SpeedConstraints ConstraintsOf(const Stretch& stretch, const RestMap& map, const SpeedGoal& goal,
                               const SpeedSpline& speed, std::size_t first_node, std::size_t last_node) {
  SpeedConstraints c;
  c.intervals.resize(last_node - first_node);
  for (const PlanLimits& l : stretch.limits()) {
    c.acceleration.push_back(kUsed * l.acceleration_m_s2);
    c.jerk.push_back(kJerkUsed * l.jerk_m_s3);
  }
  for (std::size_t k = 0; k < c.intervals.size(); ++k) {
    const double from = speed.u[first_node + k], to = speed.u[first_node + k + 1];
    const double middle = 0.5 * (from + to);
    const double feed = stretch.Feed_m_s(map.At(middle).way_m);
    for (std::size_t m = 0; m < kSpeedPlaces; ++m) {
      const double u =
          m + 1 == kSpeedPlaces ? to : from + (to - from) * static_cast<double>(m) / (kSpeedPlaces - 1);
      const ParameterDerivatives x = AtParameter(stretch, map, u, middle);
      c.intervals[k][m] = {kInfinite, kInfinite, (to - from) / (kSpeedPlaces - 1), 1.0, x.first,
                           x.second,  x.third};
      LimitSpeed(stretch, goal, feed, c.intervals[k][m]);
    }
    if (k == 0) continue;
    // A node is the end of one interval and the begin of the next.
    SpeedConstraints::Place& end = c.intervals[k - 1].back();
    SpeedConstraints::Place& begin = c.intervals[k][0];
    begin.cap = end.cap = std::min(begin.cap, end.cap);
    begin.feed_cap = end.feed_cap = std::min(begin.feed_cap, end.feed_cap);
  }
  return c;
}

double SafeFloor(const Stretch& stretch, const RestMap& map, const SpeedSpline& speed, const SpeedGoal& goal,
                 std::size_t first_node) {
  double floor = kInfinite;
  constexpr std::size_t kBlock = 1024;
  for (std::size_t begin = first_node; begin + 1 < speed.u.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, speed.u.size() - 1);
    const SpeedConstraints c = ConstraintsOf(stretch, map, goal, speed, begin, end);
    for (const auto& places : c.intervals) {
      for (const SpeedConstraints::Place& p : places) {
        floor = std::min(floor, p.cap);
        for (std::size_t i = 0; i < p.first.size(); ++i)
          floor = std::min({floor, c.acceleration[i] / std::abs(p.second[i]),
                            std::pow(c.jerk[i] / std::abs(p.third[i]), 2.0 / 3.0)});
      }
    }
  }
  return kFloorShare * floor;
}

double LargestUse(const SpeedConstraints& c, const SpeedSpline& speed, std::size_t first_node) {
  double used = 0.0;
  for (std::size_t k = 0; k < c.intervals.size(); ++k) {
    const std::size_t i = first_node + k;
    const IntervalWeights weights = WeightsOf(speed, i);
    for (std::size_t m = 0; m < kSpeedPlaces; ++m) {
      const auto of = [&](const SpeedWeights& w) {
        return w[0] * speed.beta[i] + w[1] * speed.beta[i + 1] + w[2] * speed.beta[i + 2];
      };
      const double w = of(weights.value[m]);
      used = std::max({used, UseOf(c, c.intervals[k][m], w, of(weights.slope[m]), of(weights.bend)),
                       w / c.intervals[k][m].cap});
    }
  }
  return used;
}

}  // namespace contour
