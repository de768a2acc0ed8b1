#include "tools/improve/default_programs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/text/format_text.h"
#include "design/commission_motions.h"

namespace contour::improve {
namespace {

// The circle of ISO 230-4 that the manuals use, or one of as many turns of a steep screw as its diameter has
// leads: what repeats with the motor's turn shows as such in no less than two.
constexpr double kRadius_mm = 10.0;
constexpr double kRadius_leads = 1.0;
/// The same for the whole way, which experiments use: a turn more than the circle's diameter.
constexpr double kLeastWay_leads = 3.0;
constexpr double kSpeed_mm_s = 50.0;
constexpr double kShareOfWay = 0.45;
constexpr double kShareOfSpeed = 0.9;
/// Of the axis's acceleration and jerk, that the curve may take.
constexpr double kShareOfCurve = 0.5;
/// The other program: shares of the first one's size and speed that no small whole numbers divide, so that
/// places, speeds and accelerations at the reversals are others.
constexpr double kSmaller = 0.62;
constexpr double kSlower = 0.37;

struct Curve {
  double radius_mm, speed_mm_s;
};

/// What the limits allow; `size` and `speed` are shares.
Curve CurveFor(const MachineConfig& machine, const WorkingSpace& space, double size, double speed) {
  double way_mm = 2e3;
  double speed_mm_s = kSpeed_mm_s, acceleration_mm_s2 = 1e9, jerk_mm_s3 = 1e12;
  for (std::size_t i = 0; i < space.names.size(); ++i) {
    way_mm = std::min(way_mm, 1e3 * (space.axes[i].high_m - space.axes[i].low_m));
    speed_mm_s = std::min(speed_mm_s, kShareOfSpeed * 1e3 * space.axes[i].max_speed_m_s);
    const AxisLimits& limits = machine.axes.at(space.names[i]).limits;
    acceleration_mm_s2 = std::min(acceleration_mm_s2, limits.acceleration_mm_s2);
    jerk_mm_s3 = std::min(jerk_mm_s3, limits.jerk_mm_s3);
  }
  const double lead_mm = machine.axes.at(space.names[space.axis]).model.mechanics.lead_mm;
  const double radius_mm = std::max(kRadius_mm, kRadius_leads * lead_mm);
  Curve curve{size * std::min(radius_mm, kShareOfWay * way_mm), speed * speed_mm_s};
  const double r_mm = curve.radius_mm;
  curve.speed_mm_s = std::min({curve.speed_mm_s, std::sqrt(kShareOfCurve * acceleration_mm_s2 * r_mm),
                               std::cbrt(kShareOfCurve * jerk_mm_s3 * r_mm * r_mm)});
  return curve;
}

ProgramText Make(const WorkingSpace& space, const Curve& c, const char* direction) {
  const std::string& axis = space.names[space.axis];
  if (space.names.size() < 2)
    return {FormatText("a sine of %.3g mm at %.3g m/min", c.radius_mm, 0.06 * c.speed_mm_s),
            FormatText("shape: sine\naxis: %s\namplitude_mm: %.6f\nfeed_mm_min: %.3f\ncycles: 4\n",
                       axis.c_str(), c.radius_mm, 60.0 * c.speed_mm_s),
            ProgramFormat::kYaml};
  const std::size_t other = space.axis == 0 ? 1 : 0;
  const std::size_t first = std::min(space.axis, other), second = std::max(space.axis, other);
  return {FormatText("a circle of %.3g mm at %.3g m/min, %s", c.radius_mm, 0.06 * c.speed_mm_s, direction),
          FormatText("shape: circle\naxes: [%s, %s]\nradius_mm: %.6f\nfeed_mm_min: %.3f\nturns: "
                     "4\ndirection: %s\n",
                     space.names[first].c_str(), space.names[second].c_str(), c.radius_mm,
                     60.0 * c.speed_mm_s, direction),
          ProgramFormat::kYaml};
}

}  // namespace

CommissionLimits UsualLimits(const AxisConfig& axis) {
  CommissionLimits limits = DefaultCommissionLimits(axis);
  const double stroke_mm = axis.limits.position_mm[1] - axis.limits.position_mm[0];
  const double inside_mm = stroke_mm - 2.0 * kLeastCommissionStroke_mm;
  const double least_mm = std::min(kLeastWay_leads * axis.model.mechanics.lead_mm, inside_mm);
  limits.travel_mm = std::max(limits.travel_mm, least_mm);
  return limits;
}

ProgramText UsualPath(const MachineConfig& machine, const WorkingSpace& space) {
  return Make(space, CurveFor(machine, space, 1.0, 1.0), "ccw");
}

ProgramText UsualCheck(const MachineConfig& machine, const WorkingSpace& space) {
  return Make(space, CurveFor(machine, space, kSmaller, kSlower), "cw");
}

}  // namespace contour::improve
