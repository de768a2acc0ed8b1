#include "daemon/program/time_law.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "daemon/program/jerk_ramp.h"
#include "daemon/program/safe_slowing.h"
#include "daemon/program/speed_constraints.h"
#include "daemon/program/speed_refinement.h"

namespace contour {
namespace {

// Nodes that are optimised at once, and how many of them are settled by it. The others are what it looks
// ahead: at five nodes to a rise of acceleration several times the way to rest.
constexpr std::size_t kWindow = 800;
constexpr std::size_t kSettled = 500;
// A change of feed waits so long for a node.
constexpr double kSoon_s = 2e-3;
// A last ramp to rest may use so much of the limits, as the path may bend there.
constexpr double kTailShare = 0.4;
// It begins where it takes a few cycles only.
constexpr double kTail_s = 3e-3;
constexpr double kTailSteps = 0.5;
constexpr double kEven_s = 1e-4;
// What is safe may be slowed down to by so much of the limits, of which it takes up a part itself: less where
// that is not enough. And it becomes so much less at once than it needs to, as the next piece may need it.
constexpr double kBoldest = 0.32;
constexpr double kGentlest = 0.08;
constexpr double kLower = 0.5;
// Nodes behind a window whose coefficients it depends on.
constexpr std::size_t kBeyondWindow = 6;
// Nodes are given up in lots, but for the last few: a node's speed depends on those next to it.
constexpr std::size_t kForgetAtOnce = 128;
constexpr std::size_t kLooksBack = 4;
constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();
constexpr double kNoLimit_m_s2 = 1e12;
// Nodes for a change of feed at once, and how often those of a stop are found anew.
constexpr std::size_t kChange = 250;
constexpr int kStopRounds = 3;
// For finding a place by its time.
constexpr int kMostSteps = 80;

/// artanh(z) / z by the square of z, which may be negative: then it is arctan(|z|) / |z|.
double ArtanhOverArgument(double squared) {
  if (std::abs(squared) < 1e-3)
    return 1.0 + squared * (1.0 / 3 + squared * (1.0 / 5 + squared * (1.0 / 7 + squared / 9)));
  const double z = std::sqrt(std::abs(squared));
  return (squared > 0.0 ? std::atanh(z) : std::atan(z)) / z;
}

}  // namespace

TimeLaw::TimeLaw(Stretch stretch, double from_m, double feed_scale)
    : stretch_(std::move(stretch)), ahead_(0.0, feed_scale), time_s_{0.0} {
  while (!stretch_.all_known() && stretch_.known_to_m() <= from_m) stretch_.Extend();
  map_ = RestMapFor(stretch_, from_m);
  goal_.feed_scale = feed_scale;
  speed_.u = {0.0};
}

// Beyond what has been planned it goes at a speed that is safe wherever the path is known, and there are
// nodes enough to slow down to what is safe on the next piece of it.
void TimeLaw::KnowAhead(std::size_t settled) {
  while (!ahead_.complete()) {
    const std::size_t last = settled + kWindow + kBeyondWindow;
    if (last < speed_.u.size()) {
      const double unplanned = speed_.u.back() - std::max(speed_.u[last], optimised_u_);
      if (unplanned >= SafeSlowing(stretch_.limits(), kGentlest, 0.0, goal_.floor).way()) return;
    }
    std::vector<double> nodes;
    ahead_.Extend(stretch_, map_, std::numeric_limits<double>::infinity(), nodes);
    Append(nodes);
  }
}

void TimeLaw::Append(const std::vector<double>& nodes) {
  const std::size_t from = speed_.u.size() - 1;
  for (const double u : nodes)
    if (u > speed_.u.back()) speed_.u.push_back(u);
  if (!grid_.empty()) grid_.insert(grid_.end(), nodes.begin(), nodes.end());
  if (speed_.u.size() == from + 1) return;
  speed_.beta.resize(speed_.u.size() + 1, goal_.floor);
  const double floor = SafeFloor(stretch_, map_, speed_, goal_, from);
  if (from == 0) {
    std::fill(speed_.beta.begin(), speed_.beta.end(), floor);
    goal_.floor = floor;
  } else if (floor < goal_.floor) {
    LowerFloor(from, kLower * floor);
  }
}

void TimeLaw::LowerFloor(std::size_t node, double floor) {
  std::fill(speed_.beta.begin() + static_cast<std::ptrdiff_t>(node), speed_.beta.end(), floor);
  const double at_u = 0.5 * (speed_.u[node - 1] + speed_.u[node]);
  for (double share = kBoldest; share >= kGentlest; share *= 0.5) {
    const SafeSlowing slowing(stretch_.limits(), share, floor, goal_.floor);
    if (share < kBoldest && at_u - slowing.way() < optimised_u_) break;
    std::size_t first = node;
    for (; first > 1 && speed_.u[first - 1] > std::max(optimised_u_, at_u - slowing.way()); --first)
      speed_.beta[first - 1] = slowing.SquareBefore(at_u - 0.5 * (speed_.u[first - 2] + speed_.u[first - 1]));
    first -= std::min<std::size_t>(first, 3);
    if (LargestUse(ConstraintsOf(stretch_, map_, goal_, speed_, first, node), speed_, first) <= 1.0) break;
  }
  goal_.floor = floor;
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

void TimeLaw::Refine(std::size_t node) {
  if (grid_.empty()) return;
  RefineByGrid(grid_, node, kWindow, speed_);
  // Where the feed was kept before, it changes now.
  if (node == changed_) RefineForChange(stretch_, map_, node, kChange, 0.0, speed_);
}

void TimeLaw::PlanWindow() {
  const std::size_t settled = time_s_.size() - 1;
  KnowAhead(settled);
  Refine(settled);
  const std::size_t end = speed_.u.size() - 1;
  // The state at a node is that of its two coefficients; at the very start both are free.
  const std::size_t first = settled == 0 ? 0 : settled + 2;
  const std::size_t last = std::min(end + 1, first + kWindow);
  if (first <= last) OptimiseSpeed(stretch_, map_, goal_, first, last, speed_);
  if (goal_.feed_may_exceed && goal_.feed_scale > 0.0 && first <= last)
    OptimiseSpeed(stretch_, map_, goal_, first, last, speed_);
  optimised_u_ = std::max(optimised_u_, speed_.u[std::min(last, end)]);
  Settle(last > end ? end : std::min(end, settled + kSettled));
}

void TimeLaw::PlanTo(double time_s) {
  while (!stops_ && time_s_.back() <= time_s && GoesOn()) PlanWindow();
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
  time_s = std::max(time_s_[forgets_ ? 1 : 0], time_s);
  // At the very instant of its begin too: no node lies behind it.
  if (stops_ && time_s >= last_s_) {
    // The ramp counts the speed that is lost.
    const JerkRamp ramp({0.0, -last_.acceleration_m_s2}, last_.speed_m_s,
                        {kNoLimit_m_s2, tail_jerk_m_s3_, 0.0});
    const double since = std::min(time_s - last_s_, tail_s_);
    const AlongCurve lost = ramp.At(since);
    if (since == tail_s_) return {last_.way_m + last_.speed_m_s * since - lost.s_m, 0.0, 0.0};
    return {last_.way_m + last_.speed_m_s * since - lost.s_m, last_.speed_m_s - lost.speed_m_s,
            -lost.acceleration_m_s2};
  }
  if (time_s >= time_s_.back()) return {map_.At(speed_.u.back()).way_m, 0.0, 0.0};
  const auto after = std::upper_bound(time_s_.begin(), time_s_.end(), time_s);
  const auto i = static_cast<std::size_t>(after - time_s_.begin()) - 1;
  const double e = SinceNode(i, time_s - time_s_[i]);
  const RestMap::Derivatives s = map_.At(speed_.u[i] + e, speed_.u[i] + 0.5 * speed_.width(i));
  const double bend = speed_.Bend(i);
  const double slope = speed_.Slope(i) + e * bend;
  const double w = speed_.Value(i) + e * (slope - 0.5 * e * bend);
  return {s.way_m, s.first * std::sqrt(w), s.second * w + 0.5 * s.first * slope};
}

double TimeLaw::SinceNode(std::size_t i, double since_s) const {
  const double width = speed_.width(i);
  const double value = speed_.Value(i), slope = speed_.Slope(i), bend = speed_.Bend(i);
  double e = std::min(width, width * since_s / (time_s_[i + 1] - time_s_[i]));
  // Newton's steps; where a speed that falls by much leads them astray, halvings.
  double low = 0.0, high = width;
  for (int k = 0; k < kMostSteps; ++k) {
    const double off_s = since_s - TimeWithin(i, e);
    if (std::abs(off_s) < 1e-13) break;
    (off_s > 0.0 ? low : high) = e;
    e += off_s * std::sqrt(value + e * (slope + 0.5 * e * bend));
    if (!(e > low && e < high)) e = 0.5 * (low + high);
  }
  return e;
}

double TimeLaw::planned_way_m() const {
  if (!stops_) return map_.At(speed_.u[time_s_.size() - 1]).way_m;
  return last_.way_m;
}

double TimeLaw::TimeAt_s(double way_m) {
  const double at_u = map_.Inverse(way_m);
  while (GoesOn() && speed_.u[time_s_.size() - 1] < at_u) PlanWindow();
  const auto settled = speed_.u.begin() + static_cast<std::ptrdiff_t>(time_s_.size());
  const auto after = std::upper_bound(speed_.u.begin(), settled, at_u);
  if (after == settled) return time_s_.back();
  if (after == speed_.u.begin()) return time_s_.front();
  const auto i = static_cast<std::size_t>(after - speed_.u.begin()) - 1;
  return time_s_[i] + TimeWithin(i, at_u - speed_.u[i]);
}

std::size_t TimeLaw::NodeAfter(double time_s) {
  const auto after = std::lower_bound(time_s_.begin(), time_s_.end(), std::max(0.0, time_s));
  const auto node = static_cast<std::size_t>(after - time_s_.begin());
  if (node == 0 || *after - time_s < kSoon_s) return node;
  // Not next to the node before.
  time_s += 0.5 * kSoon_s;
  const double at_u = speed_.u[node - 1] + SinceNode(node - 1, time_s - time_s_[node - 1]);
  time_s_.insert(after, time_s);
  speed_.Insert(node - 1, at_u);
  return node;
}

double TimeLaw::ChangeFeed(double time_s, double scale) {
  PlanTo(time_s);
  if (stops_ ? time_s >= last_s_ : time_s >= time_s_.back()) return time_s;
  const std::size_t node = NodeAfter(time_s);
  if (node + 1 >= speed_.u.size()) return duration_s();
  time_s_.resize(node + 1);
  stops_ = false;
  goal_.feed_may_exceed = scale < goal_.feed_scale || goal_.feed_may_exceed;
  goal_.feed_scale = scale;
  changed_ = node;
  if (scale > 0.0) MakeGrid(node);
  if (scale == 0.0) EndBySlowing();
  return time_s_[node];
}

void TimeLaw::MakeGrid(std::size_t node) {
  ahead_ = SpeedGrid(speed_.u[node], goal_.feed_scale);
  std::vector<double> nodes{speed_.u[node]};
  while (!ahead_.complete() && ahead_.at_u() < speed_.u.back())
    ahead_.Extend(stretch_, map_, speed_.u.back(), nodes);
  grid_.clear();
  Append(nodes);
  grid_ = std::move(nodes);
}

void TimeLaw::ForgetBefore(double time_s) {
  const auto after = std::upper_bound(time_s_.begin(), time_s_.end(), time_s);
  const auto at = static_cast<std::size_t>(after - time_s_.begin());
  // What is decided next begins at the last node that is settled.
  const std::size_t needed = std::min(at, time_s_.size() - 1);
  if (needed < kForgetAtOnce + kLooksBack) return;
  const std::size_t gone = needed - kLooksBack;
  const auto drop = [&](std::vector<double>& v) {
    v.erase(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(gone));
  };
  drop(time_s_);
  drop(speed_.u);
  drop(speed_.beta);
  changed_ = changed_ < gone ? kNowhere : changed_ - gone;
  grid_.erase(grid_.begin(), std::lower_bound(grid_.begin(), grid_.end(), speed_.u.front()));
  forgets_ = true;
  stretch_.ForgetBefore(map_.At(speed_.u.front()).way_m);
}

bool TimeLaw::EndWithin(std::size_t from, double slow_m_s, double jerk_m_s3) {
  for (std::size_t i = std::max<std::size_t>(from, 1); i + 1 < time_s_.size(); ++i) {
    const State s = AtNode(i);
    const double rounding = 0.5 * s.acceleration_m_s2 * s.acceleration_m_s2 / jerk_m_s3;
    // Almost at rest it may creep on evenly.
    const bool slows = s.acceleration_m_s2 <= kEven_s * jerk_m_s3;
    if (s.speed_m_s > slow_m_s || !slows || rounding > s.speed_m_s) continue;
    stops_ = true;
    time_s_.resize(i + 1);
    last_ = s;
    last_.acceleration_m_s2 = std::min(0.0, s.acceleration_m_s2);
    last_s_ = time_s_.back();
    tail_jerk_m_s3_ = jerk_m_s3;
    tail_s_ =
        JerkRamp({0.0, -last_.acceleration_m_s2}, s.speed_m_s, {kNoLimit_m_s2, jerk_m_s3, 0.0}).duration_s();
    return true;
  }
  return false;
}

void TimeLaw::EndBySlowing() {
  double jerk = std::numeric_limits<double>::infinity();
  for (const PlanLimits& l : stretch_.limits()) jerk = std::min(jerk, kTailShare * l.jerk_m_s3);
  const std::size_t from = time_s_.size() - 1;
  const State now = AtNode(from);
  const double step_s = StepTime_s(stretch_, now.way_m, now.speed_m_s);
  const double tail_s = std::isfinite(step_s) ? std::max(kTail_s, kTailSteps * step_s) : kTail_s;
  const double slow_m_s = jerk * tail_s * tail_s;
  // The place of rest shows once it has been planned, and then needs nodes.
  for (int round = 0; round < kStopRounds; ++round) {
    time_s_.resize(from + 1);
    RefineForChange(stretch_, map_, from, kWindow, 0.25 * slow_m_s, speed_);
    PlanWindow();
  }
  for (std::size_t next = from; !EndWithin(next, slow_m_s, jerk) && GoesOn();) {
    next = time_s_.size() - 1;
    PlanWindow();
  }
}

}  // namespace contour
