#include "daemon/rt/stop_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/stop_on_path.h"

namespace contour {

using stop_on_path::kFarthest, stop_on_path::kLongest, stop_on_path::kSearches;

namespace {

/// Axes looked at in one cycle, about; some tens of microseconds when the frames have been sent.
constexpr std::uint32_t kWork = 1500;
/// Of a place, looked at to choose r'' and to see what came of it.
constexpr std::uint32_t kLooks = 2;
/// A shape is this much gentler than the fixed ramp, in time. The last is as long as is allowed.
constexpr std::array<double, 5> kGentler{1.0, 1.2, 1.4, 1.7, kLongest};
/// Tries of one shape.
constexpr std::uint32_t kTries = 4;
/// Where the rate has fallen too fast, it may fall this much as fast.
constexpr double kSlower = 0.5;
/// Places nearer than so many periods are one.
constexpr double kNear = 16.0;
/// Less steep than this part of the fixed ramp's steepest slope it is not the slope that does not fit.
constexpr double kLeast = 0.02;
/// r'' in parts of the fixed ramp's: at most so much down and up.
constexpr double kDown = 2.0;
constexpr double kUp = 1.2;
/// The distance to a place is counted in periods at this rate at least.
constexpr double kSlowest = 0.05;

/// What rounding makes of the rate 1.
constexpr double kOwnPace = 1.0 + 1e-9;

double Unlimited(double value) { return value > 0.0 ? value : std::numeric_limits<double>::infinity(); }

}  // namespace

PathPace StopRamp(const PathPace& from, double since, double length) noexcept {
  const double s = std::min(1.0, since / length);
  const double slope = length * from.rate_change;
  const double travelled = length * (from.rate * (s - s * s * s + 0.5 * s * s * s * s) +
                                     slope * s * s * (0.5 - 2.0 / 3.0 * s + 0.25 * s * s));
  if (s >= 1.0) return {from.time + travelled, 0.0, 0.0};
  return {from.time + travelled,
          from.rate * (1.0 - s * s * (3.0 - 2.0 * s)) + slope * s * (1.0 - s) * (1.0 - s),
          (-6.0 * from.rate * s * (1.0 - s) + slope * (1.0 - s) * (1.0 - 3.0 * s)) / length};
}

StopSearch::StopSearch(const PerAxis<StopLimits>& limits, double period_s, double ramp_periods)
    : axes_(limits.size()), ramp_periods_(ramp_periods) {
  for (const StopLimits& l : limits) {
    acceleration_m_.push_back(Unlimited(l.acceleration_m_s2) * period_s * period_s);
    jerk_m_.push_back(Unlimited(l.jerk_m_s3) * period_s * period_s * period_s);
  }
}

void StopSearch::Begin(std::uint64_t earliest) noexcept {
  since_ = earliest;
  trying_ = false;
  ramp_ = true;
  gentler_ = tries_ = 0;
  place_count_ = 0;
}

StopSearch::Found StopSearch::Work(const PathPoints& path, std::uint64_t earliest) noexcept {
  work_ = 0;
  while (work_ < kWork) {
    // Grid points were skipped.
    if (trying_ && begin_ < earliest) trying_ = false;
    if (!trying_ && !Try(path, earliest)) return Found::kNothing;
    const Step step = ramp_ ? TryRamp(path) : TryLaw(path);
    if (step == Step::kAtRest) return ramp_ ? Found::kRamp : Found::kLaw;
    if (step == Step::kGoesOn) continue;
    trying_ = false;
    if (ramp_) {
      ramp_ = false;
    } else if (!Gentler()) {
      Begin(since_);  // of the same search, from a later point on, that is in another cycle
      ramp_ = false;
      break;
    }
  }
  const double searched = static_cast<double>(earliest - since_);
  return searched < kSearches * ramp_periods_ ? Found::kNotYet : Found::kNothing;
}

// It begins where its search has come to an end, at the latest.
bool StopSearch::Try(const PathPoints& path, std::uint64_t earliest) noexcept {
  const auto longest = static_cast<std::uint32_t>(kLongest * ramp_periods_ * static_cast<double>(axes_));
  begin_ = earliest + (work_ + kLooks * longest) / kWork;
  steps_ = 0;
  pace_ = {static_cast<double>(begin_), 1.0, 0.0};
  trying_ = Look(path, pace_.time);
  TakeAccelerations(pace_);
  return trying_;
}

// What comes next of the shapes and the places at which they fall less steeply; false: there is nothing.
bool StopSearch::Gentler() noexcept {
  const double fall = kSlower * -pace_.rate_change;
  if (++tries_ < kTries && pace_.rate > 0.0 && fall > kLeast * 1.5 / ramp_periods_) {
    Place* near = nullptr;
    for (std::size_t i = 0; i < place_count_; ++i)
      if (std::abs(places_[i].time - pace_.time) < kNear) near = &places_[i];
    if (near != nullptr) {
      *near = {std::min(near->time, pace_.time), std::min(kSlower * near->fall, fall)};
      return true;
    }
    if (place_count_ < kPlaces) {
      places_[place_count_++] = {pace_.time, fall};
      return true;
    }
  }
  tries_ = 0;
  place_count_ = 0;
  return ++gentler_ < kGentler.size();
}

StopSearch::Step StopSearch::TryRamp(const PathPoints& path) noexcept {
  const PathPace from{static_cast<double>(begin_), 1.0, 0.0};
  const PathPace next = StopRamp(from, static_cast<double>(++steps_), ramp_periods_);
  if (!Look(path, next.time) || !Keeps(path, pace_, next)) return Step::kFails;
  pace_ = next;
  return next.rate == 0.0 ? Step::kAtRest : Step::kGoesOn;
}

StopSearch::Step StopSearch::TryLaw(const PathPoints& path) noexcept {
  if (Rests(pace_)) {
    ++steps_;
    return Step::kAtRest;
  }
  const double far = static_cast<double>(begin_) + kFarthest * ramp_periods_;
  if (pace_.time > far || ++steps_ > static_cast<std::uint32_t>(kLongest * ramp_periods_))
    return Step::kFails;
  const PathPace next = Onward(path, pace_);
  if (next.rate < 0.0 || next.rate > kOwnPace || !Look(path, next.time) || !Keeps(path, pace_, next))
    return Step::kFails;
  pace_ = next;
  return Step::kGoesOn;
}

PathPace StopSearch::After(const PathPoints& path, const PathPace& pace) noexcept {
  if (pace.rate == 0.0) return pace;
  Look(path, pace.time);
  TakeAccelerations(pace);
  if (Rests(pace)) return {pace.time + 0.5 * pace.rate, 0.0, 0.0};
  return Onward(path, pace);
}

// False: it is not known what lies there.
bool StopSearch::Look(const PathPoints& path, double time) noexcept {
  work_ += static_cast<std::uint32_t>(axes_);
  const auto index = static_cast<std::uint64_t>(std::max(static_cast<double>(path.first), time));
  if (index + 1 >= path.end) {
    motion_.fill({});
    return path.whole;
  }
  const double s = std::max(0.0, time - static_cast<double>(index));
  for (std::size_t i = 0; i < axes_; ++i) {
    const Interpolated q = path.Between(i, index, s);
    motion_[i] = {q.first, q.second, q.third};
  }
  return true;
}

void StopSearch::TakeAccelerations(const PathPace& pace) noexcept {
  for (std::size_t i = 0; i < axes_; ++i)
    acceleration_[i] =
        pace.rate * pace.rate * motion_[i].acceleration + pace.rate_change * motion_[i].velocity;
}

// So slow that the rest of the way to a stand is within half of what the jerk allows of one period.
bool StopSearch::Rests(const PathPace& pace) const noexcept {
  for (std::size_t i = 0; i < axes_; ++i)
    if (pace.rate * std::abs(motion_[i].velocity) > 0.5 * jerk_m_[i] ||
        std::abs(acceleration_[i]) > jerk_m_[i])
      return false;
  return true;
}

// As the shape has it: down to its steepest slope, and to rest along r' = -sqrt(2 r'' r).
double StopSearch::Wanted(const PathPace& pace) const noexcept {
  const double length = kGentler[gentler_] * ramp_periods_;
  const double up = 6.0 / (length * length);
  double fall = 1.5 / length;
  for (std::size_t i = 0; i < place_count_; ++i) {
    const Place& p = places_[i];
    if (pace.time >= p.time + 1.0) continue;
    fall = std::min(fall, p.fall + up * std::max(0.0, p.time - pace.time) / std::max(kSlowest, pace.rate));
  }
  const double landing = std::sqrt(2.0 * up * std::max(0.0, pace.rate + 0.5 * pace.rate_change));
  return std::clamp(-std::min(fall, landing) - pace.rate_change, -kDown * up, kUp * up);
}

// With r'' = bend the pace would be `next`, where the path has been looked at; all that depends on it is
// taken as linear there.
double StopSearch::Allowed(const PathPace& next, double bend, double wanted) const noexcept {
  double least = -std::numeric_limits<double>::infinity(), most = -least;
  for (std::size_t i = 0; i < axes_; ++i) {
    const Motion& m = motion_[i];
    const double there = next.rate * next.rate * m.acceleration + next.rate_change * m.velocity;
    const double slope = next.rate * m.acceleration + m.velocity +
                         (next.rate * next.rate * m.jerk + next.rate_change * m.acceleration) / 6.0;
    double low = std::max(acceleration_[i] - jerk_m_[i], -acceleration_m_[i]);
    double high = std::min(acceleration_[i] + jerk_m_[i], acceleration_m_[i]);
    if (low > high) low = high = acceleration_[i] - std::copysign(jerk_m_[i], acceleration_[i]);
    if (slope == 0.0) continue;
    double from = bend + (low - there) / slope, to = bend + (high - there) / slope;
    if (from > to) std::swap(from, to);
    least = std::max(least, from);
    most = std::min(most, to);
  }
  return least > most ? 0.5 * (least + most) : std::clamp(wanted, least, most);
}

PathPace StopSearch::Onward(const PathPoints& path, const PathPace& pace) noexcept {
  const double length = kGentler[gentler_] * ramp_periods_;
  const double up = 6.0 / (length * length);
  const auto with = [&](double bend) {
    return PathPace{pace.time + pace.rate + 0.5 * pace.rate_change + bend / 6.0,
                    pace.rate + pace.rate_change + 0.5 * bend, pace.rate_change + bend};
  };
  const double wanted = Wanted(pace);
  const PathPace straight = with(wanted);
  Look(path, straight.time);
  return with(std::clamp(Allowed(straight, wanted, wanted), -kDown * up, kUp * up));
}

// From one pace to the next, where the path has been looked at.
bool StopSearch::Keeps(const PathPoints& path, const PathPace& from, const PathPace& to) noexcept {
  const std::array<double, kMaxAxes> before = acceleration_;
  TakeAccelerations(to);
  for (std::size_t i = 0; i < axes_; ++i) {
    const bool kept = std::abs(acceleration_[i] - before[i]) <= kWithin * jerk_m_[i] &&
                      std::abs(acceleration_[i]) <= kWithin * acceleration_m_[i];
    if (!kept && !Own(path, i, from.time, to.time)) return false;
  }
  return true;
}

// Whether the path as it is goes beyond the limits there.
bool StopSearch::Own(const PathPoints& path, std::size_t axis, double from, double to) noexcept {
  const auto here = static_cast<std::uint64_t>(from);
  const std::uint64_t first = std::max(path.first, here - std::min<std::uint64_t>(here, 1));
  const std::uint64_t last = std::min(path.end, static_cast<std::uint64_t>(to) + 3);
  const double square_s2 = path.period_s * path.period_s;
  work_ += static_cast<std::uint32_t>(last - std::min(first, last));
  for (std::uint64_t i = first; i + 1 < last; ++i) {
    const double now_m = path.At(axis, i).acceleration_m_s2 * square_s2;
    const double next_m = path.At(axis, i + 1).acceleration_m_s2 * square_s2;
    if (std::abs(next_m - now_m) > kWithin * jerk_m_[axis] ||
        std::abs(now_m) > kWithin * acceleration_m_[axis])
      return true;
  }
  return false;
}

}  // namespace contour
