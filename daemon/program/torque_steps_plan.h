#pragma once

#include <string>
#include <vector>

#include "daemon/program/motion_plan.h"

namespace contour {

/// Steps of torque on an axis at rest. While they last a damped spring holds the axis: so weak that the axis
/// moves freely against friction, so stiff that the largest torque pushes it no further than the stated
/// travel, even without any friction. It comes and goes by way of a stiffer one, so that the controller takes
/// over close to where it let go.
class TorqueStepsPlan : public MotionPlan {
 public:
  /// Throws ProgramError when torque or travel are beyond the axis's limits; `origin` begins the message.
  TorqueStepsPlan(const TorqueStepsShape& shape, std::size_t axis, const PerAxis<double>& start_m,
                  const PerAxis<PlanLimits>& limits, const std::string& origin);

  [[nodiscard]] std::size_t axis_count() const override { return start_m_.size(); }
  [[nodiscard]] double duration_s() const override { return points_.back().time_s; }
  void At(double time_s, PerAxis<ReferencePoint>& axes) const override;
  [[nodiscard]] double Distance_m(const PerAxis<double>& point_m) const override;
  [[nodiscard]] double Turns(double) const override { return 0.0; }
  [[nodiscard]] bool Scored(double time_s) const override { return time_s >= 1.0 && time_s <= duration_s(); }
  [[nodiscard]] std::optional<CommandedCircle> circle() const override { return std::nullopt; }
  [[nodiscard]] bool is_hold() const override { return false; }
  [[nodiscard]] bool Moves(std::size_t axis) const override { return axis == axis_; }

  [[nodiscard]] double spring_N_m() const { return spring_N_m_; }

 private:
  struct Point {
    double time_s = 0.0;
    double torque_Nm = 0.0;
  };

  PerAxis<double> start_m_;
  std::size_t axis_;
  double spring_N_m_ = 0.0;
  double stiffer_N_m_ = 0.0;
  std::vector<Point> points_;  ///< torque is linear between them
};

}  // namespace contour
