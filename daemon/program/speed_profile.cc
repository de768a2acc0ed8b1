#include "daemon/program/speed_profile.h"

#include <algorithm>
#include <cmath>

#include "daemon/program/bisection.h"

namespace contour {
namespace {

AlongCurve Ramp(double from, double to, double duration, double time) {
  const double u = duration > 0.0 ? time / duration : 1.0;
  const double change = to - from;
  return {from * time + change * duration * u * u * u * (1.0 - 0.5 * u),
          from + change * u * u * (3.0 - 2.0 * u),
          duration > 0.0 ? 6.0 * change / duration * u * (1.0 - u) : 0.0};
}

}  // namespace

double RampTime_s(double from_m_s, double to_m_s, const RampLimits& limits) {
  const double change = std::abs(to_m_s - from_m_s);
  if (change == 0.0) return 0.0;
  double time = std::max(limits.shortest_ramp_s, 1.5 * change / limits.acceleration_m_s2);
  if (limits.jerk_m_s3 > 0.0) time = std::max(time, std::sqrt(6.0 * change / limits.jerk_m_s3));
  return time;
}

double RampLength_m(double from_m_s, double to_m_s, const RampLimits& limits) {
  return 0.5 * (from_m_s + to_m_s) * RampTime_s(from_m_s, to_m_s, limits);
}

double ReachableSpeed_m_s(double from_m_s, double length_m, double cap_m_s, const RampLimits& limits) {
  if (cap_m_s <= from_m_s || RampLength_m(from_m_s, cap_m_s, limits) <= length_m) return cap_m_s;
  return LargestThat([&](double to_m_s) { return RampLength_m(from_m_s, to_m_s, limits) <= length_m; },
                     from_m_s, cap_m_s);
}

SpeedProfile::SpeedProfile(double length_m, double in_m_s, double cruise_m_s, double out_m_s,
                           const RampLimits& limits)
    : length_m_(length_m), in_m_s_(in_m_s), cruise_m_s_(cruise_m_s), out_m_s_(out_m_s) {
  const auto ramps = [&](double cruise) {
    return RampLength_m(in_m_s, cruise, limits) + RampLength_m(cruise, out_m_s, limits);
  };
  if (ramps(cruise_m_s_) > length_m_)
    cruise_m_s_ = LargestThat([&](double peak_m_s) { return ramps(peak_m_s) <= length_m; },
                              std::max(in_m_s, out_m_s), cruise_m_s);
  up_s_ = RampTime_s(in_m_s, cruise_m_s_, limits);
  down_s_ = RampTime_s(cruise_m_s_, out_m_s, limits);
  cruise_s_ = std::max(0.0, (length_m_ - run_up_length_m() - run_down_length_m()) / cruise_m_s_);
}

AlongCurve SpeedProfile::At(double time_s) const {
  if (time_s <= 0.0) return {0.0, in_m_s_, 0.0};
  if (time_s >= duration_s()) return {length_m_, out_m_s_, 0.0};
  if (time_s < up_s_) return Ramp(in_m_s_, cruise_m_s_, up_s_, time_s);
  if (time_s < up_s_ + cruise_s_) {
    return {run_up_length_m() + cruise_m_s_ * (time_s - up_s_), cruise_m_s_, 0.0};
  }
  // Counted from the end, so that the piece ends exactly where it should.
  const double left_s = duration_s() - time_s;
  const AlongCurve back = Ramp(out_m_s_, cruise_m_s_, down_s_, left_s);
  return {length_m_ - back.s_m, back.speed_m_s, -back.acceleration_m_s2};
}

}  // namespace contour
