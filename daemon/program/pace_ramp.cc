#include "daemon/program/pace_ramp.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace contour {
namespace {

/// Of the limits; what they are proved by is finite differences.
constexpr double kWithin = 1.01;
/// One attempt is longer than the one before by this.
constexpr double kLonger = 1.25;
constexpr double kShortest_periods = 4.0;
constexpr double kLongest_s = 30.0;
/// Points behind the end of a ramp that are looked at, and one.
constexpr double kBeyond = 4.0;
/// Of the limits.
constexpr double kAtRest = 1e-6;

/// Difference of the given order over points one period apart, oldest first.
double Difference(const std::array<double, 4>& p, int order) {
  if (order == 1) return p[3] - p[2];
  if (order == 2) return p[3] - 2.0 * p[2] + p[1];
  return p[3] - 3.0 * p[2] + 3.0 * p[1] - p[0];
}

}  // namespace

PerAxis<ReferencePoint> PaceRamp::At(double time) const {
  PerAxis<ReferencePoint> axes;
  walk_.At(std::max(0.0, time * period_s_), axes);
  return axes;
}

// Within what nobody could tell from rest: the end of a line is found by its number, to a fraction of a
// period.
bool PaceRamp::AtRest(double time) const {
  const PerAxis<ReferencePoint> axes = At(time);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const ReferencePoint& p = axes[i];
    if (std::abs(p.velocity_m_s) > kAtRest * limits_[i].velocity_m_s ||
        std::abs(p.acceleration_m_s2) > kAtRest * limits_[i].acceleration_m_s2 || p.extra_torque_Nm != 0.0)
      return false;
  }
  return true;
}

// What the axes need at the present speed, if the program did nothing else.
double PaceRamp::Shortest(double time, double change_of_rate) const {
  const PerAxis<ReferencePoint> axes = At(time);
  double periods = kShortest_periods;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const double speed = std::abs(axes[i].velocity_m_s * change_of_rate);
    const PlanLimits& l = limits_[i];
    periods = std::max(periods, 1.5 * speed / (l.acceleration_m_s2 * period_s_));
    if (l.jerk_m_s3 > 0.0) periods = std::max(periods, std::sqrt(6.0 * speed / l.jerk_m_s3) / period_s_);
  }
  return periods;
}

// Whether the program as it is written has the same difference near that time, or a larger one.
bool PaceRamp::Own(std::size_t axis, double time, int order, double found) const {
  std::array<double, 4> p{};
  double before_m_s2 = 0.0;
  for (int step = -4; step <= 3; ++step) {
    const ReferencePoint at = At(time + step)[axis];
    std::rotate(p.begin(), p.begin() + 1, p.end());
    p[3] = at.position_m;
    const double change_m = (at.acceleration_m_s2 - before_m_s2) * period_s_ * period_s_;
    before_m_s2 = at.acceleration_m_s2;
    if (step < -1) continue;
    if (std::abs(Difference(p, order)) >= found || (order == 3 && std::abs(change_m) >= found)) return true;
  }
  return false;
}

// Velocity, acceleration and jerk by the differences of the positions; jerk also by that of the accelerations
// handed out, which tells more of a jerk that changes from one period to the next.
bool PaceRamp::Fits(const PaceLaw& law, double from, double to) const {
  const std::size_t axes = limits_.size();
  std::array<std::array<double, 4>, kMaxAxes> p{};
  std::array<double, kMaxAxes> acceleration_m{};
  const double first = std::floor(from) - 3.0;
  const double h = period_s_;
  for (double index = first; index <= to + 3.0; index += 1.0) {
    const PaceState at = law.At(std::max(0.0, index));
    if (at.rate < 0.0) return false;
    const PerAxis<ReferencePoint> there = At(at.time);
    for (std::size_t i = 0; i < axes; ++i) {
      const ReferencePoint& r = there[i];
      std::rotate(p[i].begin(), p[i].begin() + 1, p[i].end());
      p[i][3] = r.position_m;
      const double before_m = acceleration_m[i];
      acceleration_m[i] = at.rate * at.rate * r.acceleration_m_s2 * h * h + at.change * r.velocity_m_s * h;
      if (index < first + 3.0) continue;
      const PlanLimits& l = limits_[i];
      const std::array<double, 3> allowed{l.velocity_m_s * h, l.acceleration_m_s2 * h * h,
                                          l.jerk_m_s3 * h * h * h};
      const std::array<double, 3> found{
          std::abs(Difference(p[i], 1)), std::abs(Difference(p[i], 2)),
          std::max(std::abs(Difference(p[i], 3)), std::abs(acceleration_m[i] - before_m))};
      for (std::size_t o = 0; o < 3; ++o) {
        if (allowed[o] <= 0.0 || found[o] <= kWithin * allowed[o]) continue;
        if (!Own(i, at.time, static_cast<int>(o) + 1, found[o])) return false;
      }
    }
  }
  return true;
}

std::optional<PaceLaw> PaceRamp::From(const PaceLaw& law, double begin, double rate, double latest) const {
  const PaceState now = law.At(begin);
  const auto with = [&](double length) {
    PaceLaw candidate = law;
    candidate.Ramp(begin, length, rate);
    return candidate;
  };
  if (AtRest(now.time) && now.change == 0.0) {
    // Nothing moves while the rate jumps; what it leads to must fit all the same.
    PaceLaw at_once = with(0.0);
    if (Fits(at_once, begin, begin + kShortest_periods)) return at_once;
  }
  const double longest = kLongest_s / period_s_;
  for (double length = Shortest(now.time, rate - now.rate); length <= longest; length *= kLonger) {
    PaceLaw candidate = with(length);
    if (candidate.At(begin + length).time + kBeyond > latest) return std::nullopt;
    if (Fits(candidate, begin, begin + length)) return candidate;
  }
  return std::nullopt;
}

std::optional<PaceLaw> PaceRamp::StopAt(const PaceLaw& law, double begin, double stop) const {
  const PaceState now = law.At(begin);
  if (now.rate <= 0.0 || stop <= now.time) return std::nullopt;
  const double room = (stop - now.time) / now.rate;  // periods at this rate
  if (AtRest(stop)) {
    PaceLaw candidate = law;
    candidate.Hold(begin + room, 0.0, Held::kEndOfLine);
    if (Fits(candidate, begin + room, begin + room)) return candidate;
  }
  // A ramp goes half as far as the rate that it begins with.
  for (double length = Shortest(stop, now.rate); 0.5 * length <= room; length *= kLonger) {
    PaceLaw candidate = law;
    candidate.Hold(begin + room - 0.5 * length, length, Held::kEndOfLine);
    if (Fits(candidate, begin + room - 0.5 * length, begin + room + 0.5 * length)) return candidate;
  }
  return std::nullopt;
}

}  // namespace contour
