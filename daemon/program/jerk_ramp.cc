#include "daemon/program/jerk_ramp.h"

#include <algorithm>
#include <cmath>

#include "daemon/program/bisection.h"

namespace contour {
namespace {

// Of a length: what rounding may take when states have been chosen to fit exactly.
constexpr double kRounding = 1e-9;

/// Constant jerk for a while.
AlongCurve After(const AlongCurve& from, double jerk, double t) {
  return {from.s_m + t * (from.speed_m_s + t * (from.acceleration_m_s2 / 2.0 + t * jerk / 6.0)),
          from.speed_m_s + t * (from.acceleration_m_s2 + t * jerk / 2.0), from.acceleration_m_s2 + t * jerk};
}

double RampsLength_m(const PassingState& in, double peak_m_s, const PassingState& out,
                     const RampLimits& limits) {
  return JerkRamp(in, peak_m_s, limits).length_m() + JerkRamp(out, peak_m_s, limits).length_m();
}

double LowestPeak_m_s(const PassingState& in, const PassingState& out, const RampLimits& limits) {
  return std::max(contour::LowestPeak_m_s(in, limits), contour::LowestPeak_m_s(out, limits));
}

}  // namespace

double LowestPeak_m_s(const PassingState& from, const RampLimits& limits) {
  return from.speed_m_s + 0.5 * from.acceleration_m_s2 * from.acceleration_m_s2 / limits.jerk_m_s3;
}

JerkRamp::JerkRamp(const PassingState& from, double to_m_s, const RampLimits& limits)
    : from_(from), jerk_m_s3_(limits.jerk_m_s3) {
  // Rising from a0 to ap and falling to zero gains (ap^2 - a0^2) / 2j + ap^2 / 2j.
  const double a0 = from.acceleration_m_s2;
  const double gain = std::max(0.0, to_m_s - from.speed_m_s);
  const double peak = std::max(a0, std::sqrt(jerk_m_s3_ * gain + 0.5 * a0 * a0));
  const double used = std::min(peak, std::max(a0, limits.acceleration_m_s2));
  rise_s_ = (used - a0) / jerk_m_s3_;
  fall_s_ = used / jerk_m_s3_;
  if (used < peak) hold_s_ = (gain - (used * used - 0.5 * a0 * a0) / jerk_m_s3_) / used;
}

double JerkRamp::length_m() const { return At(duration_s()).s_m; }

AlongCurve JerkRamp::At(double time_s) const {
  AlongCurve state{0.0, from_.speed_m_s, from_.acceleration_m_s2};
  state = After(state, jerk_m_s3_, std::clamp(time_s, 0.0, rise_s_));
  time_s -= rise_s_;
  if (time_s <= 0.0) return state;
  state = After(state, 0.0, std::min(time_s, hold_s_));
  time_s -= hold_s_;
  if (time_s <= 0.0) return state;
  return After(state, -jerk_m_s3_, std::min(time_s, fall_s_));
}

bool JerkProfile::Fits(double length_m, const PassingState& in, const PassingState& out,
                       const RampLimits& limits) {
  return RampsLength_m(in, LowestPeak_m_s(in, out, limits), out, limits) <= length_m * (1.0 + kRounding);
}

JerkProfile::JerkProfile(double length_m, const PassingState& in, double cruise_m_s, const PassingState& out,
                         const RampLimits& limits)
    : length_m_(length_m), cruise_m_s_(cruise_m_s) {
  if (RampsLength_m(in, cruise_m_s, out, limits) > length_m)
    cruise_m_s_ =
        LargestThat([&](double peak_m_s) { return RampsLength_m(in, peak_m_s, out, limits) <= length_m; },
                    LowestPeak_m_s(in, out, limits), cruise_m_s);
  up_ = JerkRamp(in, cruise_m_s_, limits);
  down_ = JerkRamp(out, cruise_m_s_, limits);
  cruise_s_ = std::max(0.0, (length_m - up_.length_m() - down_.length_m()) / cruise_m_s_);
}

AlongCurve JerkProfile::At(double time_s) const {
  if (time_s <= up_.duration_s()) return up_.At(time_s);
  const double left_s = duration_s() - time_s;
  if (left_s > down_.duration_s()) {
    return {up_.length_m() + cruise_m_s_ * (time_s - up_.duration_s()), cruise_m_s_, 0.0};
  }
  // Counted from the end, so that the piece ends exactly where it should.
  const AlongCurve back = down_.At(left_s);
  return {length_m_ - back.s_m, back.speed_m_s, -back.acceleration_m_s2};
}

}  // namespace contour
