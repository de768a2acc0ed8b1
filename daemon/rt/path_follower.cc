#include "daemon/rt/path_follower.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace contour {
namespace {

/// Quintic Hermite interpolation on [0, 1] through position, velocity and acceleration (per period) at both
/// ends; gives the value and its first two derivatives at s.
struct Interpolated {
  double value, first, second;
};
Interpolated Quintic(double p0, double v0, double a0, double p1, double v1, double a1, double s) noexcept {
  const double d = p1 - p0;
  const double c3 = 10 * d - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1;
  const double c4 = -15 * d + 8 * v0 + 7 * v1 + 1.5 * a0 - a1;
  const double c5 = 6 * d - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1;
  return {p0 + s * (v0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5)))),
          v0 + s * (a0 + s * (3 * c3 + s * (4 * c4 + s * 5 * c5))),
          a0 + s * (6 * c3 + s * (12 * c4 + s * 20 * c5))};
}

}  // namespace

PathFollower::PathFollower(std::size_t axes, double period_s, double stop_periods, std::size_t horizon)
    : axes_(axes),
      period_s_(period_s),
      stop_periods_(std::max(1.0, stop_periods)),
      horizon_(std::min(horizon, kMaxHorizonPoints)),
      hold_m_(axes) {
  if (0.5 * stop_periods_ + static_cast<double>(horizon_) + 16.0 > static_cast<double>(kCapacity)) {
    throw std::invalid_argument("a stop on the path would need more than " + std::to_string(kCapacity) +
                                " path points ahead; raise limits.acceleration_mm_s2 or limits.jerk_mm_s3, "
                                "or lower limits.velocity_mm_s");
  }
}

void PathFollower::Hold(const PerAxis<double>& position_m) noexcept {
  hold_m_ = position_m;
  mode_ = Mode::kHolding;
  expecting_ = false;
  have_last_ = false;
  first_ = end_ = 0;
  clock_ = 0;
  UpdatePaces();
}

void PathFollower::Expect(std::uint32_t program_id) noexcept {
  program_id_ = program_id;
  expecting_ = true;
  have_last_ = false;
  first_ = end_ = 0;
  law_ = refused_law_ = 0;
}

void PathFollower::Accept(const PathPoint& point) noexcept {
  if (!expecting_ || point.program_id != program_id_) return;
  if (point.law != law_ && !TakesLaw(point)) return;
  if (have_last_ || Room() == 0) return;
  // Points that are here already come again before those of another law, so that there is no gap.
  if (point.index != PathPoint::kNextIndex && point.index != end_) return;
  if (end_ == 0) begins_with_axes_ = point.axes.size();
  for (std::size_t i = 0; i < axes_; ++i) points_[i][end_ % kCapacity] = point.axes[i];
  marks_[end_ % kCapacity] = {point.program_time_s, point.line};
  ++end_;
  have_last_ = point.last;
}

// What was to come from the point on is forgotten; it has been seen by nobody yet.
bool PathFollower::TakesLaw(const PathPoint& point) noexcept {
  if (point.law == refused_law_) return false;
  if (point.index < EarliestSplice() || point.index > end_) {
    refused_law_ = point.law;
    return false;
  }
  law_ = point.law;
  end_ = point.index;
  have_last_ = false;
  return true;
}

// Points that must lie ahead for a controlled stop to be possible.
double PathFollower::Reserve() const noexcept {
  return 0.5 * stop_periods_ + static_cast<double>(horizon_) + 2.0;
}

// What is left in front of the splice is enough for a stop until the first points behind it are here.
std::uint64_t PathFollower::EarliestSplice() const noexcept {
  if (mode_ != Mode::kRunning) return PathProgress::kNowhere;
  const auto now = static_cast<std::uint64_t>(std::max<std::int64_t>(0, clock_));
  return now + static_cast<std::uint64_t>(std::ceil(Reserve())) + kSpliceMargin;
}

PathProgress PathFollower::progress() const noexcept { return {EarliestSplice(), end_, law_, refused_law_}; }

PathPoint PathFollower::First() const noexcept {
  PathPoint point;
  point.program_id = program_id_;
  point.axes.resize(begins_with_axes_);
  for (std::size_t i = 0; i < std::min(axes_, begins_with_axes_); ++i) point.axes[i] = At(i, first_);
  return point;
}

std::size_t PathFollower::Room() const noexcept {
  if (!expecting_) return 0;
  // Behind the last point only another law can come, while there is time for it.
  if (have_last_) return mode_ == Mode::kRunning ? 1 : 0;
  return kCapacity - waiting();
}

bool PathFollower::Prefetched() const noexcept {
  if (!expecting_) return false;
  return have_last_ || Room() == 0;
}

void PathFollower::Start() noexcept {
  mode_ = Mode::kRunning;
  // Horizon element 1 is the first instant the new torque acts at; the path begins there, element 0 is still
  // at rest.
  clock_ = -1;
  UpdatePaces();
}

void PathFollower::BeginStop() noexcept {
  if (mode_ != Mode::kRunning) return;
  mode_ = Mode::kStopping;
  // Elements 0 and 1 are past or about to be carried out; the ramp begins after them.
  stop_clock_ = clock_ + 1;
  UpdatePaces();
}

PathFollower::Pace PathFollower::PaceAfter(int periods_from_head) const noexcept {
  const double t = static_cast<double>(clock_ + periods_from_head);
  if (mode_ == Mode::kRunning) {
    if (t <= 0.0) return {0.0, 0.0, 0.0};
    return {t, 1.0, 0.0};
  }
  // Stopping: rate 1 - (3 s^2 - 2 s^3), s = time since the ramp began over its length; the integral is exact.
  const double begin = static_cast<double>(stop_clock_);
  if (t <= begin) return {std::max(0.0, t), t <= 0.0 ? 0.0 : 1.0, 0.0};
  const double s = std::min(1.0, (t - begin) / stop_periods_);
  const double travelled = stop_periods_ * (s - s * s * s + 0.5 * s * s * s * s);
  const double rate = 1.0 - s * s * (3.0 - 2.0 * s);
  const double change = s >= 1.0 ? 0.0 : -6.0 * s * (1.0 - s) / stop_periods_;
  return {std::max(0.0, begin) + travelled, s >= 1.0 ? 0.0 : rate, change};
}

void PathFollower::UpdatePaces() noexcept {
  if (!moving()) return;
  const std::size_t count = mode_ == Mode::kRunning ? 1 : horizon_;
  for (std::size_t j = 0; j < count; ++j) pace_[j] = PaceAfter(static_cast<int>(j));
}

PathFollower::Pace PathFollower::PaceAt(std::size_t j) const noexcept {
  return mode_ == Mode::kRunning ? PaceAfter(static_cast<int>(j)) : pace_[j];
}

void PathFollower::Advance() noexcept {
  if (!moving()) return;
  ++clock_;
  UpdatePaces();
  DropPassed();
  const double last_time = static_cast<double>(end_ - 1);
  if (have_last_ && pace_[0].time >= last_time) {
    mode_ = Mode::kEnded;
    for (std::size_t i = 0; i < axes_; ++i) hold_m_[i] = At(i, end_ - 1).position_m;
  } else if (mode_ == Mode::kStopping && pace_[0].rate == 0.0 && clock_ > stop_clock_) {
    for (std::size_t i = 0; i < axes_; ++i) hold_m_[i] = Evaluate(i, pace_[0]).position_m;
    mode_ = Mode::kHolding;
  }
  if (!moving()) expecting_ = false;
}

void PathFollower::DropPassed() noexcept {
  const auto now = static_cast<std::uint64_t>(pace_[0].time);
  if (now > first_ + kBehind) first_ = std::min(now - kBehind, end_ - 1);
}

bool PathFollower::running_dry() const noexcept {
  if (mode_ != Mode::kRunning || have_last_) return false;
  const double left = static_cast<double>(end_ - 1) - std::max(0.0, pace_[0].time);
  return left < Reserve();
}

double PathFollower::ProgramTime_s(std::uint64_t index) const noexcept {
  const double told_s = MarkAt(index).program_time_s;
  return told_s >= 0.0 ? told_s : static_cast<double>(index) * period_s_;
}

std::uint64_t PathFollower::IndexNow() const noexcept {
  const double bounded = std::max(static_cast<double>(first_), pace_[0].time);
  return std::min(static_cast<std::uint64_t>(bounded), end_ - 1);
}

ProgramPlace PathFollower::program_place() const noexcept {
  if (end_ == 0 || mode_ == Mode::kHolding) return {};
  const Pace& now = pace_[0];
  const double rate = moving() ? now.rate : 0.0;
  const std::uint64_t index = IndexNow();
  const Mark& here = MarkAt(index);
  if (here.program_time_s < 0.0) return {now.time * period_s_, rate, here.line};
  if (index + 1 >= end_) return {here.program_time_s, 0.0, here.line};
  const double step_s = ProgramTime_s(index + 1) - here.program_time_s;
  const double since = std::max(0.0, now.time - static_cast<double>(index));
  return {here.program_time_s + since * step_s, rate * step_s / period_s_, here.line};
}

ReferencePoint PathFollower::Evaluate(std::size_t axis, const Pace& pace) const noexcept {
  const auto last = end_ - 1;
  const double bounded = std::max(static_cast<double>(first_), pace.time);
  auto index = static_cast<std::uint64_t>(bounded);
  const double s = bounded - static_cast<double>(index);
  if (index >= last) return {At(axis, last).position_m, 0.0, 0.0};
  const ReferencePoint& a = At(axis, index);
  if (s == 0.0 && pace.rate == 1.0 && pace.rate_change == 0.0) return a;
  const ReferencePoint& b = At(axis, index + 1);
  const double h = period_s_;
  const auto q = Quintic(a.position_m, a.velocity_m_s * h, a.acceleration_m_s2 * h * h, b.position_m,
                         b.velocity_m_s * h, b.acceleration_m_s2 * h * h, s);
  // An extra torque belongs to the program's own pace: it fades with it. A spring stays to the end of a stop.
  return {q.value, pace.rate * q.first / h,
          (pace.rate * pace.rate * q.second + pace.rate_change * q.first) / (h * h),
          pace.rate * (a.extra_torque_Nm + s * (b.extra_torque_Nm - a.extra_torque_Nm)),
          a.spring_N_m + s * (b.spring_N_m - a.spring_N_m)};
}

void PathFollower::Copy(std::size_t axis, std::uint64_t first, std::size_t count,
                        ReferencePoint* to) const noexcept {
  // Up to the end of the ring, and from its beginning.
  while (count > 0) {
    const std::size_t from = first % kCapacity;
    const std::size_t run = std::min(count, kCapacity - from);
    std::copy_n(points_[axis].data() + from, run, to);
    first += run;
    to += run;
    count -= run;
  }
}

void PathFollower::Horizon(std::size_t axis, std::size_t points, AxisHorizon& out) const noexcept {
  out.resize(std::min(points, horizon_));
  std::size_t j = 0;
  if (!moving()) {
    for (; j < out.size(); ++j) out[j] = {hold_m_[axis], 0.0, 0.0};
  }
  if (mode_ == Mode::kRunning && clock_ > static_cast<std::int64_t>(first_)) {
    // At the program's own pace elements are the points themselves, see Evaluate.
    const auto now = static_cast<std::uint64_t>(clock_);
    if (now + 1 < end_) {
      j = std::min<std::size_t>(out.size(), end_ - 1 - now);
      Copy(axis, now, j, out.data());
    }
  }
  for (; j < out.size(); ++j) out[j] = Evaluate(axis, PaceAt(j));
}

ReferencePoint PathFollower::Near(std::size_t axis, int offset) const noexcept {
  if (!moving()) return {hold_m_[axis], 0.0, 0.0};
  Pace pace = pace_[0];
  pace.time += offset;
  return Evaluate(axis, pace);
}

void PathFollower::Around(std::size_t axis, int reach, AxisHorizon& out) const noexcept {
  out.clear();
  const auto first = static_cast<std::int64_t>(first_), end = static_cast<std::int64_t>(end_);
  if (mode_ == Mode::kRunning && clock_ > 0 && clock_ - reach >= first && clock_ + reach + 1 < end) {
    out.resize(2 * static_cast<std::size_t>(reach) + 1);
    Copy(axis, static_cast<std::uint64_t>(clock_ - reach), out.size(), out.data());
    return;
  }
  for (int j = -reach; j <= reach; ++j) out.push_back(Near(axis, j));
}

}  // namespace contour
