#include "daemon/program/piece_limits.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace contour {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// Rounding in the sums below must not refuse a program that goes exactly to a limit.
constexpr double kTolerance = 1e-9;

std::string Number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

[[noreturn]] void Refuse(const PieceRequest& request, const std::string& axis, const std::string& what,
                         double value, double limit, const std::string& unit) {
  throw ProgramError(request.origin + ": axis " + axis + ": " + what + " " + Number(value) + " " + unit +
                     " is beyond the limit of " + Number(limit) + " " + unit);
}

bool InPlane(const CurvePiece& curve, std::size_t axis) {
  return axis == curve.axis[0] || axis == curve.axis[1];
}

/// Of the curve in its plane, per s: a helix bends less than its circle.
double Curvature_1_m(const CurvePiece& curve) {
  return curve.radius_m > 0.0 ? curve.round_share * curve.round_share / curve.radius_m : 0.0;
}

/// Largest share of the speed along the piece that one axis takes.
double Share(const CurvePiece& curve, std::size_t axis) {
  switch (curve.kind) {
    case CurvePiece::Kind::kPoint:
      break;
    case CurvePiece::Kind::kLine:
      return std::abs(curve.direction[axis]);
    case CurvePiece::Kind::kArc:
      return InPlane(curve, axis) ? curve.round_share : std::abs(curve.direction[axis]);
    case CurvePiece::Kind::kSine:
      return InPlane(curve, axis) ? 1.0 : 0.0;
  }
  return 0.0;
}

bool IsStraight(const CurvePiece& curve) {
  return curve.kind == CurvePiece::Kind::kPoint || curve.kind == CurvePiece::Kind::kLine;
}

double Jerk(const PlanLimits& limits) { return limits.jerk_m_s3 > 0.0 ? limits.jerk_m_s3 : kInfinite; }

}  // namespace

Extent CheckRange(const PieceRequest& request, const PerAxis<PlanLimits>& limits) {
  const Extent extent = ExtentOf(request.curve);
  const bool straight = IsStraight(request.curve);
  const CurvePoint begin = PointAt(request.curve, 0.0);
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const PlanLimits& l = limits[i];
    // An axis that stands beyond its limits, where a fault left it, is driven back. Along a straight line it
    // goes one way; and a path that has come in does not begin outside any more.
    const double lowest_m = straight ? std::min(l.position_min_m, begin.position_m[i]) : l.position_min_m;
    const double highest_m = straight ? std::max(l.position_max_m, begin.position_m[i]) : l.position_max_m;
    if (extent.min_m[i] < lowest_m - kTolerance) {
      Refuse(request, l.axis, "position", extent.min_m[i] * 1e3, l.position_min_m * 1e3, "mm");
    }
    if (extent.max_m[i] > highest_m + kTolerance) {
      Refuse(request, l.axis, "position", extent.max_m[i] * 1e3, l.position_max_m * 1e3, "mm");
    }
  }
  return extent;
}

void CheckPiece(const PieceRequest& request, const PerAxis<PlanLimits>& limits) {
  CheckRange(request, limits);
  const CurvePiece& curve = request.curve;
  const double v = request.speed_m_s;
  const double curvature = Curvature_1_m(curve);
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const double share = Share(curve, i);
    if (share == 0.0) continue;
    const PlanLimits& l = limits[i];
    const double allowed = 1.0 + kTolerance;
    if (v * share > l.velocity_m_s * allowed) {
      Refuse(request, l.axis, "velocity", v * share * 1e3, l.velocity_m_s * 1e3, "mm/s");
    }
    if (curvature == 0.0 || !InPlane(curve, i)) continue;
    const double centripetal = v * v * curvature;
    if (centripetal > l.acceleration_m_s2 * allowed) {
      Refuse(request, l.axis, "acceleration of the curve", centripetal * 1e3, l.acceleration_m_s2 * 1e3,
             "mm/s^2");
    }
    const double jerk = centripetal * v * curve.round_share / curve.radius_m;
    if (jerk > Jerk(l) * allowed) {
      Refuse(request, l.axis, "jerk of the curve", jerk * 1e3, Jerk(l) * 1e3, "mm/s^3");
    }
  }
}

double LargestSpeed_m_s(const CurvePiece& curve, const PerAxis<PlanLimits>& limits) {
  double speed = kInfinite;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const double share = Share(curve, i);
    if (share > 0.0) speed = std::min(speed, limits[i].velocity_m_s / share);
  }
  return speed;
}

RampLimits RampLimitsOf(const PieceRequest& request, const PerAxis<PlanLimits>& limits) {
  double acceleration = kInfinite;
  double jerk = kInfinite;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const double share = Share(request.curve, i);
    if (share == 0.0) continue;
    acceleration = std::min(acceleration, limits[i].acceleration_m_s2 / share);
    jerk = std::min(jerk, Jerk(limits[i]) / share);
  }
  const double curvature = Curvature_1_m(request.curve);
  if (curvature > 0.0) {
    const double radius = 1.0 / curvature;
    // With a_t = dv/dt, the acceleration is (a_t, v^2/r) along and across, the jerk (da_t/dt - v^3/r^2,
    // 3 v a_t / r). Each of the two parts of the jerk gets what makes their sum of squares fit.
    const double v = request.speed_m_s;
    const double centripetal = v * v / radius;
    constexpr double kHalf = 0.70710678;
    acceleration = std::sqrt(std::max(0.0, acceleration * acceleration - centripetal * centripetal));
    if (jerk < kInfinite) {
      acceleration = std::min(acceleration, kHalf * jerk * radius / (3.0 * v));
      jerk = kHalf * jerk - centripetal * v / radius;
    }
    if (!(acceleration > 0.0 && jerk > 0.0)) {
      throw ProgramError(request.origin + ": the curve at " + Number(v * 1e3) +
                         " mm/s leaves nothing of the acceleration and jerk limits for reaching this speed");
    }
  }
  return {acceleration, jerk < kInfinite ? jerk : 0.0, request.shortest_ramp_s};
}

}  // namespace contour
