#pragma once

#include <memory>
#include <string>
#include <vector>

#include "daemon/program/motion_plan.h"

namespace contour {

/// Another plan with a torque added on one axis, faded in and out at its ends.
class TorquePlan : public MotionPlan {
 public:
  /// Throws ProgramError when the torque is beyond the axis's limit or faster than half the cycle's rate;
  /// `origin` begins the message, or where the frequency is written.
  TorquePlan(std::shared_ptr<const MotionPlan> inner, const TorqueSignal& signal, std::size_t axis,
             const PerAxis<PlanLimits>& limits, const std::string& origin);

  [[nodiscard]] std::size_t axis_count() const override { return inner_->axis_count(); }
  [[nodiscard]] double duration_s() const override { return inner_->duration_s(); }
  void At(double time_s, PerAxis<ReferencePoint>& axes) const override;
  [[nodiscard]] double Distance_m(const PerAxis<double>& point_m) const override {
    return inner_->Distance_m(point_m);
  }
  [[nodiscard]] double Turns(double time_s) const override { return inner_->Turns(time_s); }
  [[nodiscard]] bool Scored(double time_s) const override { return inner_->Scored(time_s); }
  [[nodiscard]] std::optional<CommandedCircle> circle() const override { return inner_->circle(); }
  [[nodiscard]] bool is_hold() const override { return false; }
  [[nodiscard]] bool Moves(std::size_t axis) const override { return axis == axis_ || inner_->Moves(axis); }

  /// Largest torque it can ask for.
  [[nodiscard]] double peak_Nm() const;

 private:
  [[nodiscard]] double Signal(double time_s) const;

  struct Line {
    double rate_rad_s = 0.0;
    double phase_rad = 0.0;
  };

  std::shared_ptr<const MotionPlan> inner_;
  TorqueSignal signal_;
  std::size_t axis_;
  std::vector<Line> lines_;  ///< multisine
};

}  // namespace contour
