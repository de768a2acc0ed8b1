#include "daemon/rt/path_follower.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace contour {
PathFollower::PathFollower(const PerAxis<StopLimits>& limits, double period_s, double stop_periods,
                           std::size_t horizon)
    : axes_(limits.size()),
      period_s_(period_s),
      stop_periods_(std::max(1.0, stop_periods)),
      horizon_(std::min(horizon, kMaxHorizonPoints)),
      hold_m_(axes_),
      search_(limits, period_s, stop_periods_) {
  if (stop_periods_ > MostRamp_periods(horizon_)) {
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

void PathFollower::BeginStop(StopKind kind) noexcept {
  if (!moving()) return;
  if (mode_ == Mode::kRunning) {
    mode_ = Mode::kStopping;
    stop_ = Stop::kSearched;
    for (std::size_t j = 0; j < horizon_; ++j) pace_[j] = OwnPace(clock_ + static_cast<std::int64_t>(j));
    search_.Begin(Point(2));
  }
  if (kind == StopKind::kShortest) TakeRamp(1);
}

// Of a horizon element. The path begins at its point 0, at rest.
std::uint64_t PathFollower::Point(std::int64_t element) const noexcept {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(1, clock_ + element));
}

// Element 2 is the next cycle's element 1, about to be carried out then; a stop that is found begins after
// it.
void PathFollower::SearchStop() noexcept {
  if (mode_ != Mode::kStopping || stop_ != Stop::kSearched) return;
  // The ramp needs what is left of the points.
  const StopSearch::Found found =
      short_of_points() ? StopSearch::Found::kNothing : search_.Work(Points(), Point(2));
  if (found == StopSearch::Found::kNotYet) return;
  if (found == StopSearch::Found::kNothing) return TakeRamp(2);
  stop_clock_ = static_cast<std::int64_t>(search_.begin());
  stop_ = found == StopSearch::Found::kRamp ? Stop::kRamp : Stop::kLaw;
  ramp_ = {static_cast<double>(stop_clock_), 1.0, 0.0};
  ramp_periods_ = stop_periods_;
  FillPaces();
}

// The shortest stop there is, after a horizon element: at the path's own pace the fixed ramp, on the way to
// rest what ends sooner.
void PathFollower::TakeRamp(std::int64_t element) noexcept {
  const std::int64_t begin = clock_ + element;
  if (stop_ == Stop::kRamp && begin >= stop_clock_) return;
  PathPace from = pace_[static_cast<std::size_t>(element)];
  double length = stop_periods_;
  if (stop_ == Stop::kLaw && begin > stop_clock_) {
    // So long that the rate does not fall below 0.
    if (from.rate_change < 0.0) length = std::min(length, -3.0 * from.rate / from.rate_change);
    if (static_cast<double>(stop_clock_ + search_.length() - begin) <= length || length < 1.0) return;
  } else {
    from = {std::max(0.0, static_cast<double>(begin)), 1.0, 0.0};
  }
  stop_clock_ = begin;
  stop_ = Stop::kRamp;
  ramp_ = from;
  ramp_periods_ = length;
  FillPaces();
}

PathPace PathFollower::OwnPace(std::int64_t clock) noexcept {
  const auto t = static_cast<double>(clock);
  return t <= 0.0 ? PathPace{} : PathPace{t, 1.0, 0.0};
}

// Of a stop, one period behind `before`.
PathPace PathFollower::PaceAfter(const PathPace& before, std::int64_t clock) noexcept {
  if (stop_ == Stop::kSearched || clock <= stop_clock_) return OwnPace(clock);
  if (stop_ == Stop::kLaw) return search_.After(Points(), before);
  return StopRamp(ramp_, static_cast<double>(clock - stop_clock_), ramp_periods_);
}

void PathFollower::FillPaces() noexcept {
  for (std::size_t j = 1; j < horizon_; ++j) {
    const std::int64_t clock = clock_ + static_cast<std::int64_t>(j);
    if (clock > stop_clock_) pace_[j] = PaceAfter(pace_[j - 1], clock);
  }
}

void PathFollower::UpdatePaces() noexcept {
  if (!moving()) return;
  if (mode_ == Mode::kRunning) {
    pace_[0] = OwnPace(clock_);
    return;
  }
  std::copy(pace_.begin() + 1, pace_.begin() + static_cast<std::ptrdiff_t>(horizon_), pace_.begin());
  pace_[horizon_ - 1] = PaceAfter(pace_[horizon_ - 2], clock_ + static_cast<std::int64_t>(horizon_) - 1);
}

PathPace PathFollower::PaceAt(std::size_t j) const noexcept {
  return mode_ == Mode::kRunning ? OwnPace(clock_ + static_cast<std::int64_t>(j)) : pace_[j];
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
  } else if (mode_ == Mode::kStopping && stop_ != Stop::kSearched && pace_[0].rate == 0.0 &&
             clock_ > stop_clock_) {
    for (std::size_t i = 0; i < axes_; ++i) hold_m_[i] = Evaluate(i, pace_[0]).position_m;
    mode_ = Mode::kHolding;
  }
  if (!moving()) expecting_ = false;
}

void PathFollower::DropPassed() noexcept {
  const auto now = static_cast<std::uint64_t>(pace_[0].time);
  if (now > first_ + kBehind) first_ = std::min(now - kBehind, end_ - 1);
}

bool PathFollower::running_dry() const noexcept { return mode_ == Mode::kRunning && short_of_points(); }

bool PathFollower::short_of_points() const noexcept {
  if (have_last_) return false;
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
  const PathPace& now = pace_[0];
  const double rate = moving() ? now.rate : 0.0;
  const std::uint64_t index = IndexNow();
  const Mark& here = MarkAt(index);
  if (here.program_time_s < 0.0) return {now.time * period_s_, rate, here.line};
  if (index + 1 >= end_) return {here.program_time_s, 0.0, here.line};
  const double step_s = ProgramTime_s(index + 1) - here.program_time_s;
  const double since = std::max(0.0, now.time - static_cast<double>(index));
  return {here.program_time_s + since * step_s, rate * step_s / period_s_, here.line};
}

ReferencePoint PathFollower::Evaluate(std::size_t axis, const PathPace& pace) const noexcept {
  const auto last = end_ - 1;
  const double bounded = std::max(static_cast<double>(first_), pace.time);
  auto index = static_cast<std::uint64_t>(bounded);
  const double s = bounded - static_cast<double>(index);
  if (index >= last) return {At(axis, last).position_m, 0.0, 0.0};
  const ReferencePoint& a = At(axis, index);
  if (s == 0.0 && pace.rate == 1.0 && pace.rate_change == 0.0) return a;
  const ReferencePoint& b = At(axis, index + 1);
  const double h = period_s_;
  const Interpolated q = Points().Between(axis, index, s);
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
  PathPace pace = pace_[0];
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
