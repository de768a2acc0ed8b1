#pragma once

#include <memory>
#include <string>
#include <vector>

#include "daemon/program/motion_plan.h"

namespace contour {

/// Plans one after the other; the machine rests where one meets the next.
class SequencePlan : public MotionPlan {
 public:
  using Plans = std::vector<std::shared_ptr<const MotionPlan>>;
  /// At least one plan, all of the same number of axes, each beginning where the one before ends.
  explicit SequencePlan(Plans plans);

  [[nodiscard]] std::size_t axis_count() const override { return plans_.front()->axis_count(); }
  [[nodiscard]] double duration_s() const override { return begin_s_.back(); }
  void At(double time_s, PerAxis<ReferencePoint>& axes) const override;
  [[nodiscard]] double Distance_m(const PerAxis<double>& point_m) const override;
  [[nodiscard]] double Turns(double) const override { return 0.0; }
  [[nodiscard]] bool Scored(double time_s) const override { return time_s >= 1.0 && time_s <= duration_s(); }
  [[nodiscard]] std::optional<CommandedCircle> circle() const override { return std::nullopt; }
  [[nodiscard]] bool is_hold() const override;
  [[nodiscard]] bool Moves(std::size_t axis) const override;

 private:
  Plans plans_;
  std::vector<double> begin_s_;  ///< of each plan, and the end of the last
};

/// Plans of different axes at the same time; who has finished waits for the others.
class TogetherPlan : public MotionPlan {
 public:
  /// Throws ProgramError when an axis is moved by two of them; `origin` begins the message.
  TogetherPlan(SequencePlan::Plans plans, const PerAxis<PlanLimits>& limits, const std::string& origin);

  [[nodiscard]] std::size_t axis_count() const override { return plans_.front()->axis_count(); }
  [[nodiscard]] double duration_s() const override { return duration_s_; }
  void At(double time_s, PerAxis<ReferencePoint>& axes) const override;
  [[nodiscard]] double Distance_m(const PerAxis<double>& point_m) const override;
  [[nodiscard]] double Turns(double) const override { return 0.0; }
  [[nodiscard]] bool Scored(double time_s) const override { return time_s >= 1.0 && time_s <= duration_s(); }
  [[nodiscard]] std::optional<CommandedCircle> circle() const override { return std::nullopt; }
  [[nodiscard]] bool is_hold() const override;
  [[nodiscard]] bool Moves(std::size_t axis) const override;

 private:
  SequencePlan::Plans plans_;
  PerAxis<std::size_t> mover_;  ///< which plan moves the axis
  double duration_s_ = 0.0;
};

}  // namespace contour
