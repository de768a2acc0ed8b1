#include "daemon/program/torque_steps_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace contour {
namespace {

/// Natural frequency of the axis on its spring: well below what delay and drive lag would make oscillate.
constexpr double kStiffest_Hz = 25.0;
/// The spring is weakened, and stiffened again, over this time.
constexpr double kTransition_s = 0.3;
/// Share of the following error limit that the travel may take up.
constexpr double kShareOfFollowingError = 0.9;

[[noreturn]] void Refuse(const std::string& origin, const std::string& axis, const char* what, double value,
                         double limit, const char* unit) {
  char text[200];
  std::snprintf(text, sizeof text, ": axis %s: %s %.4g is beyond the limit of %.4g %s", axis.c_str(), what,
                value, limit, unit);
  throw ProgramError(origin + text);
}

}  // namespace

TorqueStepsPlan::TorqueStepsPlan(const TorqueStepsShape& shape, std::size_t axis,
                                 const PerAxis<double>& start_m, const PerAxis<PlanLimits>& limits,
                                 const std::string& origin)
    : start_m_(start_m), axis_(axis) {
  const PlanLimits& l = limits[axis];
  double largest_Nm = 0.0;
  for (const double torque : shape.torques_Nm) largest_Nm = std::max(largest_Nm, std::abs(torque));
  const double travel_m = shape.travel_mm * 1e-3;
  if (!(largest_Nm <= l.torque_Nm)) Refuse(origin, l.axis, "torques_Nm:", largest_Nm, l.torque_Nm, "Nm");
  if (travel_m > kShareOfFollowingError * l.following_error_m)
    Refuse(origin, l.axis, "travel_mm", shape.travel_mm, kShareOfFollowingError * 1e3 * l.following_error_m,
           "mm");
  if (start_m[axis] - travel_m < l.position_min_m)
    Refuse(origin, l.axis, "position", 1e3 * (start_m[axis] - travel_m), 1e3 * l.position_min_m, "mm");
  if (start_m[axis] + travel_m > l.position_max_m)
    Refuse(origin, l.axis, "position", 1e3 * (start_m[axis] + travel_m), 1e3 * l.position_max_m, "mm");
  spring_N_m_ = largest_Nm / l.radius_m_rad / travel_m;
  const double rate = 2.0 * std::numbers::pi * kStiffest_Hz;
  stiffer_N_m_ = std::min(l.mass_kg * rate * rate, l.stiffest_spring_N_m);
  if (spring_N_m_ > stiffer_N_m_) {
    char text[220];
    std::snprintf(
        text, sizeof text,
        ": axis %s: travel_mm %.4g is too short to hold %.4g Nm by a spring, expected at least %.4g",
        l.axis.c_str(), shape.travel_mm, largest_Nm, 1e3 * largest_Nm / l.radius_m_rad / stiffer_N_m_);
    throw ProgramError(origin + text);
  }
  double now_s = kTransition_s;
  points_ = {{0.0, 0.0}, {now_s, 0.0}};
  const auto add = [&](double after_s, double torque_Nm) {
    points_.push_back({now_s += after_s, torque_Nm});
  };
  for (int repeat = 0; repeat < shape.repeats; ++repeat) {
    for (const double torque_Nm : shape.torques_Nm) {
      add(shape.rise_s, torque_Nm);
      add(shape.hold_s, torque_Nm);
      add(shape.rise_s, 0.0);
      add(shape.rest_s, 0.0);
    }
  }
  add(kTransition_s, 0.0);
}

void TorqueStepsPlan::At(double time_s, PerAxis<ReferencePoint>& axes) const {
  axes.resize(start_m_.size());
  for (std::size_t i = 0; i < start_m_.size(); ++i) {
    axes[i] = {};
    axes[i].position_m = start_m_[i];
  }
  if (time_s <= 0.0 || time_s >= duration_s()) return;
  const auto after = std::upper_bound(points_.begin(), points_.end(), time_s,
                                      [](double t, const Point& p) { return t < p.time_s; });
  const Point& a = *(after - 1);
  const Point& b = *after;
  axes[axis_].extra_torque_Nm =
      a.torque_Nm + (b.torque_Nm - a.torque_Nm) * (time_s - a.time_s) / (b.time_s - a.time_s);
  const double edge = std::clamp(std::min(time_s, duration_s() - time_s) / kTransition_s, 0.0, 1.0);
  axes[axis_].spring_N_m = stiffer_N_m_ * std::pow(spring_N_m_ / stiffer_N_m_, edge);
}

double TorqueStepsPlan::Distance_m(const PerAxis<double>& point_m) const {
  double squared = 0.0;
  for (std::size_t i = 0; i < start_m_.size(); ++i) squared += std::pow(point_m[i] - start_m_[i], 2);
  return std::sqrt(squared);
}

}  // namespace contour
