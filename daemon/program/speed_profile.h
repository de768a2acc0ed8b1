#pragma once

namespace contour {

/// Limits along a curve, SI. A ramp is never shorter than shortest_ramp_s.
struct RampLimits {
  double acceleration_m_s2 = 0.0;
  double jerk_m_s3 = 0.0;  ///< 0: not limited
  double shortest_ramp_s = 0.0;
};

/// A change of speed whose acceleration is a parabola, zero at both ends:
/// v(u) = v0 + (v1 - v0) (3 u^2 - 2 u^3), u = t / T.
/// T is the shortest with |a| <= 1.5 |v1 - v0| / T and |jerk| <= 6 |v1 - v0| / T^2 within the limits.
double RampTime_s(double from_m_s, double to_m_s, const RampLimits& limits);

/// Way covered by that ramp: its mean speed is (v0 + v1) / 2.
double RampLength_m(double from_m_s, double to_m_s, const RampLimits& limits);

/// Largest speed, at most `cap`, that a ramp from `from` reaches within `length` (read backwards: the largest
/// speed from which it comes down to `from`). Not below `from`.
double ReachableSpeed_m_s(double from_m_s, double length_m, double cap_m_s, const RampLimits& limits);

/// Where on a curve, and how fast, at one instant.
struct AlongCurve {
  double s_m = 0.0;
  double speed_m_s = 0.0;
  double acceleration_m_s2 = 0.0;
};

/// One piece of curve from speed `in` to speed `out`: ramp to the cruising speed, cruise, ramp.
class SpeedProfile {
 public:
  SpeedProfile() = default;
  /// `in` and `out` at most `cruise`; both must be reachable from each other within `length`. When the piece
  /// is too short for the cruising speed, the profile peaks below it.
  SpeedProfile(double length_m, double in_m_s, double cruise_m_s, double out_m_s, const RampLimits& limits);

  [[nodiscard]] double duration_s() const { return up_s_ + cruise_s_ + down_s_; }
  [[nodiscard]] double run_up_length_m() const { return 0.5 * (in_m_s_ + cruise_m_s_) * up_s_; }
  [[nodiscard]] double run_down_length_m() const { return 0.5 * (cruise_m_s_ + out_m_s_) * down_s_; }
  [[nodiscard]] double cruise_m_s() const { return cruise_m_s_; }
  [[nodiscard]] AlongCurve At(double time_s) const;

 private:
  double length_m_ = 0.0;
  double in_m_s_ = 0.0;
  double cruise_m_s_ = 0.0;
  double out_m_s_ = 0.0;
  double up_s_ = 0.0;
  double cruise_s_ = 0.0;
  double down_s_ = 0.0;
};

}  // namespace contour
