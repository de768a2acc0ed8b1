#pragma once

#include "daemon/program/speed_profile.h"

namespace contour {

/// How fast a path passes a point; the acceleration points away from the slower side, towards the cruise.
struct PassingState {
  double speed_m_s = 0.0;
  double acceleration_m_s2 = 0.0;
};

/// Speed that is reached when the acceleration is taken back at once: no ramp from there ends below it.
double LowestPeak_m_s(const PassingState& from, const RampLimits& limits);

/// The fastest change of speed from a state that may already accelerate, to a higher speed without
/// acceleration: jerk up, constant acceleration, jerk down.
class JerkRamp {
 public:
  JerkRamp() = default;
  /// `to` not below LowestPeak_m_s; the acceleration of `from` within the limits, whose jerk is above zero.
  JerkRamp(const PassingState& from, double to_m_s, const RampLimits& limits);

  [[nodiscard]] double duration_s() const { return rise_s_ + hold_s_ + fall_s_; }
  [[nodiscard]] double length_m() const;
  [[nodiscard]] AlongCurve At(double time_s) const;

 private:
  PassingState from_;
  double jerk_m_s3_ = 0.0;
  double rise_s_ = 0.0;
  double hold_s_ = 0.0;
  double fall_s_ = 0.0;
};

/// A piece of path from one passing state to another: ramp, cruise, ramp, as fast as the limits allow.
class JerkProfile {
 public:
  JerkProfile() = default;
  /// `in` and `out` must fit (see Fits); when the piece is too short for `cruise`, the profile peaks below
  /// it.
  JerkProfile(double length_m, const PassingState& in, double cruise_m_s, const PassingState& out,
              const RampLimits& limits);

  /// Is there a way from `in` to `out` within the length?
  static bool Fits(double length_m, const PassingState& in, const PassingState& out,
                   const RampLimits& limits);

  [[nodiscard]] double duration_s() const { return up_.duration_s() + cruise_s_ + down_.duration_s(); }
  [[nodiscard]] AlongCurve At(double time_s) const;

 private:
  double length_m_ = 0.0;
  double cruise_m_s_ = 0.0;
  double cruise_s_ = 0.0;
  JerkRamp up_;
  JerkRamp down_;  ///< backwards from the end
};

}  // namespace contour
