#include "daemon/program/oscillation_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace contour {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
// Samples per period of the highest frequency when looking for extremes: 1 - cos(pi / 32) = 0.5 % low at
// most.
constexpr double kSamplesPerPeriod = 32.0;

/// A value with its first two derivatives by time; products and compositions by the rules of calculus.
struct Jet {
  double value = 0.0;
  double rate = 0.0;
  double second = 0.0;
};

Jet operator*(const Jet& a, const Jet& b) {
  return {a.value * b.value, a.rate * b.value + a.value * b.rate,
          a.second * b.value + 2.0 * a.rate * b.rate + a.value * b.second};
}

Jet operator+(const Jet& a, const Jet& b) {
  return {a.value + b.value, a.rate + b.rate, a.second + b.second};
}

Jet Sin(const Jet& x) {
  const double s = std::sin(x.value);
  const double c = std::cos(x.value);
  return {s, c * x.rate, c * x.second - s * x.rate * x.rate};
}

/// 10 u^3 - 15 u^4 + 6 u^5: value, slope and curvature continuous at both ends.
Jet FadeIn(double time_s, double fade_s) {
  if (time_s <= 0.0) return {};
  if (time_s >= fade_s) return {1.0, 0.0, 0.0};
  const double u = time_s / fade_s;
  return {u * u * u * (10.0 + u * (6.0 * u - 15.0)), 30.0 * u * u * (1.0 - u) * (1.0 - u) / fade_s,
          60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) / (fade_s * fade_s)};
}

Jet FadeOut(double left_s, double fade_s) {
  const Jet in = FadeIn(left_s, fade_s);
  return {in.value, -in.rate, in.second};
}

double FadeTime(double seconds, double lowest_hz) {
  return std::min(0.25 * seconds, std::max(0.5, 1.0 / lowest_hz));
}

[[noreturn]] void Refuse(const std::string& origin, const std::string& axis, const char* what, double value,
                         double limit, const char* unit) {
  char text[200];
  std::snprintf(text, sizeof text, ": axis %s: %s %.6g %s is beyond the limit of %.6g %s", axis.c_str(), what,
                value * 1e3, unit, limit * 1e3, unit);
  throw ProgramError(origin + text);
}

}  // namespace

OscillationPlan::OscillationPlan(const MultisineShape& shape, std::size_t axis,
                                 const PerAxis<double>& start_m, const PerAxis<PlanLimits>& limits,
                                 const std::string& origin)
    : start_m_(start_m),
      axis_(axis),
      duration_s_(shape.seconds),
      fade_s_(FadeTime(shape.seconds, shape.frequency_min_hz)) {
  const double ratio = shape.frequency_max_hz / shape.frequency_min_hz;
  for (int k = 0; k < shape.lines; ++k) {
    const double place = shape.lines > 1 ? static_cast<double>(k) / (shape.lines - 1) : 0.0;
    const double rate = kTurn_rad * shape.frequency_min_hz * std::pow(ratio, place);
    // Schroeder's phases (IEEE Trans. Information Theory 16, 1970) keep the peak of the sum low.
    const double phase = -std::numbers::pi * k * (k + 1) / shape.lines;
    lines_.push_back({shape.velocity_mm_s * 1e-3 / rate, rate, phase});
  }
  CheckLimits(limits[axis], shape.frequency_max_hz, origin);
}

OscillationPlan::OscillationPlan(const SweepShape& shape, std::size_t axis, const PerAxis<double>& start_m,
                                 const PerAxis<PlanLimits>& limits, const std::string& origin)
    : start_m_(start_m),
      axis_(axis),
      duration_s_(shape.seconds),
      fade_s_(FadeTime(shape.seconds, shape.frequency_min_hz)),
      velocity_m_s_(shape.velocity_mm_s * 1e-3),
      first_rad_s_(kTurn_rad * shape.frequency_min_hz),
      growth_1_s_(std::log(shape.frequency_max_hz / shape.frequency_min_hz) / shape.seconds) {
  CheckLimits(limits[axis], shape.frequency_max_hz, origin);
}

ReferencePoint OscillationPlan::Oscillation(double time_s) const {
  const double t = std::clamp(time_s, 0.0, duration_s_);
  Jet sum;
  for (const Line& line : lines_) {
    const Jet sine = Sin({line.rate_rad_s * t + line.phase_rad, line.rate_rad_s, 0.0});
    sum = sum + Jet{line.amplitude_m, 0.0, 0.0} * sine;
  }
  if (lines_.empty()) {
    const double rate = first_rad_s_ * std::exp(growth_1_s_ * t);
    const double amplitude = velocity_m_s_ / rate;
    sum = Jet{amplitude, -growth_1_s_ * amplitude, growth_1_s_ * growth_1_s_ * amplitude} *
          Sin({(rate - first_rad_s_) / growth_1_s_, rate, growth_1_s_ * rate});
  }
  const Jet x = FadeIn(t, fade_s_) * FadeOut(duration_s_ - t, fade_s_) * sum;
  return {x.value, x.rate, x.second};
}

void OscillationPlan::CheckLimits(const PlanLimits& limits, double highest_hz, const std::string& origin) {
  const double step = 1.0 / (kSamplesPerPeriod * highest_hz);
  const auto samples = static_cast<std::uint64_t>(duration_s_ / step);
  double velocity = 0.0;
  double acceleration = 0.0;
  double jerk = 0.0;
  double previous = 0.0;
  for (std::uint64_t i = 0; i <= samples; ++i) {
    const ReferencePoint p = Oscillation(static_cast<double>(i) * step);
    // A reversal between two samples, by the parabola through this one.
    const bool turns = std::abs(p.velocity_m_s) < step * std::abs(p.acceleration_m_s2);
    const double beyond_m = turns ? 0.5 * p.velocity_m_s * p.velocity_m_s / p.acceleration_m_s2 : 0.0;
    lowest_m_ = std::min(lowest_m_, p.position_m - beyond_m);
    highest_m_ = std::max(highest_m_, p.position_m - beyond_m);
    velocity = std::max(velocity, std::abs(p.velocity_m_s));
    acceleration = std::max(acceleration, std::abs(p.acceleration_m_s2));
    jerk = std::max(jerk, std::abs(p.acceleration_m_s2 - previous) / step);
    previous = p.acceleration_m_s2;
  }
  lowest_m_ += start_m_[axis_];
  highest_m_ += start_m_[axis_];
  if (lowest_m_ < limits.position_min_m) {
    Refuse(origin, limits.axis, "position", lowest_m_, limits.position_min_m, "mm");
  }
  if (highest_m_ > limits.position_max_m) {
    Refuse(origin, limits.axis, "position", highest_m_, limits.position_max_m, "mm");
  }
  if (velocity > limits.velocity_m_s) {
    Refuse(origin, limits.axis, "velocity", velocity, limits.velocity_m_s, "mm/s");
  }
  if (acceleration > limits.acceleration_m_s2) {
    Refuse(origin, limits.axis, "acceleration", acceleration, limits.acceleration_m_s2, "mm/s^2");
  }
  if (limits.jerk_m_s3 > 0.0 && jerk > limits.jerk_m_s3) {
    Refuse(origin, limits.axis, "jerk", jerk, limits.jerk_m_s3, "mm/s^3");
  }
}

void OscillationPlan::At(double time_s, PerAxis<ReferencePoint>& axes) const {
  axes.resize(start_m_.size());
  for (std::size_t i = 0; i < start_m_.size(); ++i) axes[i] = {start_m_[i], 0.0, 0.0};
  axes[axis_] = Oscillation(time_s);
  axes[axis_].position_m += start_m_[axis_];
}

double OscillationPlan::Distance_m(const PerAxis<double>& point_m) const {
  double squared = 0.0;
  for (std::size_t i = 0; i < start_m_.size(); ++i) {
    const double nearest = i == axis_ ? std::clamp(point_m[i], lowest_m_, highest_m_) : start_m_[i];
    squared += std::pow(point_m[i] - nearest, 2);
  }
  return std::sqrt(squared);
}

}  // namespace contour
