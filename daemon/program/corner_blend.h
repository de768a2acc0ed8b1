#pragma once

#include <optional>

#include "daemon/program/jerk_ramp.h"
#include "daemon/program/motion_plan.h"

namespace contour {

/// What a corner's blend may use of one of its two straight legs.
struct BlendLeg {
  PerAxis<double> direction;  ///< of travel
  double cruise_m_s = 0.0;    ///< programmed speed
  RampLimits ramp;            ///< along the leg; jerk above zero
  double straight_m = 0.0;    ///< the blend itself must end within it
  double room_m = 0.0;        ///< and its acceleration be taken back within this
};

/// A corner between two straight legs, taken before the first leg has come to rest in it: the axes' motions
/// overlap. With the unit vectors m = (u1 + u2) / |u1 + u2| and n = (u2 - u1) / |u2 - u1| of the directions
/// u1 and u2, c and s the cosine and sine of half the turning angle, and t from -tau to tau about the middle,
///   along m:  vc t + jm t^3 / 6
///   along n:  h + a t^2 / 2 - jn |t|^3 / 6
/// Position, velocity and acceleration meet both legs when, with k = s / c,
///   a = tau (jn + k jm),  vc = tau^2 (jn / k + jm) / 2,  h = tau^3 (jn + k jm) / 6;
/// the path is then farthest from the programmed one in the middle, by c h. Jerk is constant in either half:
/// jm m + jn n before, jm m - jn n after the middle.
class CornerBlend {
 public:
  /// The blend that loses the least time against full speed on both legs, within `deviation_m` of the path
  /// and the axes' limits of acceleration and jerk (above zero). Nothing: the path hardly turns or turns
  /// back.
  static std::optional<CornerBlend> Fastest(const BlendLeg& before, const BlendLeg& after,
                                            const PerAxis<double>& corner_m, double deviation_m,
                                            const PerAxis<PlanLimits>& limits);

  /// The same blend in a shorter time, thus slower and closer to the corner; 0 is a stop.
  [[nodiscard]] CornerBlend Scaled(double factor) const;

  [[nodiscard]] double duration_s() const { return 2.0 * half_s_; }
  [[nodiscard]] double cut_m() const;      ///< taken off either leg
  [[nodiscard]] PassingState leg() const;  ///< where it meets either leg
  [[nodiscard]] double deviation_m() const;
  void At(double since_begin_s, PerAxis<ReferencePoint>& axes) const;

 private:
  double half_s_ = 0.0;       // tau
  double jerk_m_m_s3_ = 0.0;  // jm
  double jerk_n_m_s3_ = 0.0;  // jn
  double cos_ = 1.0;
  double sin_ = 0.0;
  PerAxis<double> corner_m_;
  PerAxis<double> m_;
  PerAxis<double> n_;

  void LimitTime(const BlendLeg& before, const BlendLeg& after, double deviation_m,
                 const PerAxis<PlanLimits>& limits);
  [[nodiscard]] double Lost_s(const BlendLeg& leg) const;
};

}  // namespace contour
