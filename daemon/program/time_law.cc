#include "daemon/program/time_law.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/program/jerk_ramp.h"
#include "daemon/program/speed_grid.h"

namespace contour {
namespace {

// Nodes that are optimised at once, and how many of them are settled by it. The others are what it looks
// ahead: at five nodes to a rise of acceleration several times the way to rest.
constexpr std::size_t kWindow = 800;
constexpr std::size_t kSettled = 500;
// A last ramp to rest may use so much of the limits, as the path may bend there.
constexpr double kTailShare = 0.4;

/// artanh(z) / z by the square of z, which may be negative: then it is arctan(|z|) / |z|.
double ArtanhOverArgument(double squared) {
  if (std::abs(squared) < 1e-3)
    return 1.0 + squared * (1.0 / 3 + squared * (1.0 / 5 + squared * (1.0 / 7 + squared / 9)));
  const double z = std::sqrt(std::abs(squared));
  return (squared > 0.0 ? std::atanh(z) : std::atan(z)) / z;
}

}  // namespace

TimeLaw::TimeLaw(std::shared_ptr<const Stretch> stretch, double from_m, double feed_scale)
    : stretch_(std::move(stretch)), map_(RestMapFor(*stretch_, from_m)), time_s_{0.0} {
  goal_.feed_scale = feed_scale;
  speed_.u = SpeedGrid(*stretch_, map_);
  goal_.floor = SafeFloor(*stretch_, map_, speed_, goal_);
  speed_.beta.assign(speed_.u.size() + 1, goal_.floor);
}

double TimeLaw::TimeWithin(std::size_t i, double since_u) const {
  const double value = speed_.Value(i), slope = speed_.Slope(i), bend = speed_.Bend(i);
  // The integral of 1 / sqrt(w) over a quadratic w, by the half angle of its hyperbolic or circular
  // functions.
  const double end = value + since_u * (slope + 0.5 * since_u * bend);
  const double mean = since_u / (std::sqrt(value) + std::sqrt(end));
  return 2.0 * mean * ArtanhOverArgument(0.5 * bend * mean * mean);
}

void TimeLaw::Settle(std::size_t node) {
  for (std::size_t i = time_s_.size() - 1; i < node; ++i)
    time_s_.push_back(time_s_.back() + TimeWithin(i, speed_.width(i)));
}

void TimeLaw::PlanWindow() {
  const std::size_t settled = time_s_.size() - 1;
  const std::size_t end = speed_.u.size() - 1;
  // The state at a node is that of its two coefficients; at the very start both are free.
  const std::size_t first = settled == 0 ? 0 : settled + 2;
  const std::size_t last = std::min(end + 1, first + kWindow);
  if (first <= last) OptimiseSpeed(*stretch_, map_, goal_, first, last, speed_);
  if (goal_.feed_may_exceed && goal_.feed_scale > 0.0 && first <= last)
    OptimiseSpeed(*stretch_, map_, goal_, first, last, speed_);
  Settle(last > end ? end : std::min(end, settled + kSettled));
}

void TimeLaw::PlanTo(double time_s) {
  while (!stops_ && time_s_.back() <= time_s && time_s_.size() < speed_.u.size()) PlanWindow();
}

bool TimeLaw::GoesOnAfter(double time_s) {
  PlanTo(time_s);
  return stops_ ? last_s_ + tail_s_ > time_s : time_s_.back() > time_s;
}

double TimeLaw::duration_s() {
  PlanTo(std::numeric_limits<double>::infinity());
  return stops_ ? last_s_ + tail_s_ : time_s_.back();
}

TimeLaw::State TimeLaw::AtNode(std::size_t node) const {
  const RestMap::Derivatives s = map_.At(speed_.u[node]);
  const double w = speed_.Value(node);
  return {s.way_m, s.first * std::sqrt(w), s.second * w + 0.5 * s.first * speed_.Slope(node)};
}

TimeLaw::State TimeLaw::At(double time_s) {
  PlanTo(time_s);
  time_s = std::max(0.0, time_s);
  if (stops_ && time_s > last_s_) {
    // The ramp counts the speed that is lost.
    const JerkRamp ramp({0.0, -last_.acceleration_m_s2}, last_.speed_m_s,
                        {kTailShare * 1e9, tail_jerk_m_s3_, 0.0});
    const double since = std::min(time_s - last_s_, tail_s_);
    const AlongCurve lost = ramp.At(since);
    if (since == tail_s_) return {last_.way_m + last_.speed_m_s * since - lost.s_m, 0.0, 0.0};
    return {last_.way_m + last_.speed_m_s * since - lost.s_m, last_.speed_m_s - lost.speed_m_s,
            -lost.acceleration_m_s2};
  }
  if (time_s >= time_s_.back()) return {map_.At(speed_.u.back()).way_m, 0.0, 0.0};
  const auto after = std::upper_bound(time_s_.begin(), time_s_.end(), time_s);
  const auto i = static_cast<std::size_t>(after - time_s_.begin()) - 1;
  const double since = time_s - time_s_[i];
  const double width = speed_.width(i);
  const double value = speed_.Value(i), slope = speed_.Slope(i), bend = speed_.Bend(i);
  const auto squared = [&](double e) { return value + e * (slope + 0.5 * e * bend); };
  double e = width * since / (time_s_[i + 1] - time_s_[i]);
  for (int k = 0; k < 8; ++k) {
    const double off = since - TimeWithin(i, e);
    e = std::clamp(e + off * std::sqrt(squared(e)), 0.0, width);
    if (std::abs(off) < 1e-13) break;
  }
  const RestMap::Derivatives s = map_.At(speed_.u[i] + e, speed_.u[i] + 0.5 * width);
  const double w = squared(e);
  return {s.way_m, s.first * std::sqrt(w), s.second * w + 0.5 * s.first * (slope + e * bend)};
}

double TimeLaw::ChangeFeed(double time_s, double scale) {
  PlanTo(time_s);
  if (stops_ ? time_s >= last_s_ : time_s >= time_s_.back()) return time_s;
  const auto node = static_cast<std::size_t>(
      std::lower_bound(time_s_.begin(), time_s_.end(), std::max(0.0, time_s)) - time_s_.begin());
  if (node + 1 >= speed_.u.size()) return duration_s();
  time_s_.resize(node + 1);
  stops_ = false;
  goal_.feed_may_exceed = scale < goal_.feed_scale || goal_.feed_may_exceed;
  goal_.feed_scale = scale;
  if (scale == 0.0) EndBySlowing();
  return time_s_[node];
}

void TimeLaw::EndBySlowing() {
  const double cycle_s = 1e-3;
  double jerk = std::numeric_limits<double>::infinity();
  for (const PlanLimits& l : stretch_->limits) jerk = std::min(jerk, kTailShare * l.jerk_m_s3);
  // Slow enough to rest within a few cycles.
  const double slow_m_s = jerk * 4.0 * cycle_s * cycle_s;
  while (time_s_.size() < speed_.u.size()) {
    const std::size_t from = time_s_.size() - 1;
    PlanWindow();
    for (std::size_t i = std::max<std::size_t>(from, 1); i + 1 < time_s_.size(); ++i) {
      const State s = AtNode(i);
      const double rounding = 0.5 * s.acceleration_m_s2 * s.acceleration_m_s2 / jerk;
      if (s.speed_m_s > slow_m_s || s.acceleration_m_s2 > 0.0 || rounding > s.speed_m_s) continue;
      stops_ = true;
      time_s_.resize(i + 1);
      last_ = s;
      last_s_ = time_s_.back();
      tail_jerk_m_s3_ = jerk;
      tail_s_ =
          JerkRamp({0.0, -s.acceleration_m_s2}, s.speed_m_s, {kTailShare * 1e9, jerk, 0.0}).duration_s();
      return;
    }
  }
}

}  // namespace contour
