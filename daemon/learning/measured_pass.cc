#include "daemon/learning/measured_pass.h"

#include <cmath>
#include <utility>

namespace contour {
namespace {

/// Rows may be missing: late feedback, a telemetry queue that was full.
constexpr double kLeastSeen = 0.98;
/// A scale that counts the other way, in another unit or not at all. Below the motion the wind-up matters.
constexpr double kScaleTolerance = 0.1;
constexpr double kSmallestMotion_m = 50e-6;

}  // namespace

MeasuredPass::MeasuredPass(std::vector<Mechanics> axes, std::size_t points, double period_s)
    : points_(points), period_s_(period_s), seen_(points, 0) {
  for (Mechanics& m : axes) axes_.push_back({m, 0.0, 0.0, std::vector<float>(points, 0.0F), 0.0, 0.0, 0.0});
}

double MeasuredPass::Zero_m(const Axis& axis, const AxisRecord& record) {
  const Mechanics& m = axis.mechanics;
  const double windup_m = record.feedback.torque_Nm / (m.radius_m_rad * m.stiffness_N_m);
  return record.feedback.table_position_m - (record.position_m - windup_m);
}

void MeasuredPass::Add(const CycleRecord& r) {
  const bool follows_last = last_cycle_ != 0 && r.cycle == last_cycle_ + 1;
  last_cycle_ = r.cycle;
  if (r.axes.size() != axes_.size()) return;
  for (const AxisRecord& a : r.axes) {
    spoilt_ = spoilt_ || a.reference.extra_torque_Nm != 0.0 || a.reference.spring_N_m != 0.0;
    // After skipped grid points a row's feedback is older than its time on the path.
    if (!a.feedback.fresh || !a.feedback.has_scale || !follows_last) return;
  }
  const double index = r.path_time_s / period_s_;
  const double whole = std::round(index);
  if (std::abs(index - whole) > 1e-3) spoilt_ = true;  // off the program's own pace
  if (!(whole >= 0.0 && whole < static_cast<double>(points_))) return;
  const auto point = static_cast<std::size_t>(whole);
  if (seen_[point] != 0) return;
  seen_[point] = 1;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    const AxisRecord& a = r.axes[i];
    const double zero_m = Zero_m(axis, a);
    if (count_ == 0) {
      axis.zero_m = zero_m;
      axis.first_motor_m = a.position_m;
    }
    axis.zero_change_m += zero_m - axis.zero_m;
    const double table_m = a.feedback.table_position_m - axis.zero_m;
    const double motor_m = a.position_m - axis.first_motor_m;
    axis.motor_square_m2 += motor_m * motor_m;
    axis.motor_scale_m2 += motor_m * (table_m - axis.first_motor_m);
    axis.behind_m[point] = static_cast<float>(a.reference.position_m - table_m);
  }
  ++count_;
}

bool MeasuredPass::ScaleFollowsMotor(const Axis& axis) const {
  const double enough_m2 = kSmallestMotion_m * kSmallestMotion_m * static_cast<double>(count_);
  if (axis.motor_square_m2 < enough_m2) return true;
  return std::abs(axis.motor_scale_m2 / axis.motor_square_m2 - 1.0) <= kScaleTolerance;
}

std::string MeasuredPass::Problem() const {
  if (spoilt_) return "it carried torque of an experiment, or did not keep its pace";
  if (static_cast<double>(count_) < kLeastSeen * static_cast<double>(points_) || count_ == 0)
    return "feedback or rows of more than 2 % of it are missing";
  for (std::size_t i = 0; i < axes_.size(); ++i)
    if (!ScaleFollowsMotor(axes_[i]))
      return "the scale of axis number " + std::to_string(i + 1) +
             " does not move as its motor does; is drive.linear_scale right?";
  return {};
}

double MeasuredPass::behind_m(std::size_t axis, std::size_t point) const {
  const Axis& a = axes_[axis];
  return static_cast<double>(a.behind_m[point]) + a.zero_change_m / static_cast<double>(count_);
}

}  // namespace contour
