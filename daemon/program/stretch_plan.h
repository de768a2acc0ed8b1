#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "daemon/program/motion_plan.h"
#include "daemon/program/path_tree.h"
#include "daemon/program/stretch_walk.h"

namespace contour {

/// G-code on a machine: smooth paths from stop to stop within the tolerance, as fast as feeds and axes allow,
/// velocity, acceleration and jerk of every axis within its limits. Planned as far as it is asked for.
class StretchPlan : public MotionPlan {
 public:
  explicit StretchPlan(StretchProgram program);

  [[nodiscard]] std::size_t axis_count() const override { return program_->start_m().size(); }
  [[nodiscard]] double duration_s() const override;
  void At(double time_s, PerAxis<ReferencePoint>& axes) const override;
  [[nodiscard]] std::uint32_t Line(double time_s) const override;
  [[nodiscard]] std::uint32_t Halts(double time_s) const override;
  [[nodiscard]] double Distance_m(const PerAxis<double>& point_m) const override;
  [[nodiscard]] double Turns(double) const override { return 0.0; }
  [[nodiscard]] bool Scored(double time_s) const override;
  [[nodiscard]] std::optional<CommandedCircle> circle() const override { return std::nullopt; }
  [[nodiscard]] bool is_hold() const override { return program_->moves().empty(); }
  [[nodiscard]] bool Moves(std::size_t axis) const override;
  [[nodiscard]] bool GoesOnAfter(double time_s) const override;
  [[nodiscard]] std::unique_ptr<PathWalk> Walk() const override;
  [[nodiscard]] bool feed_may_change() const override { return true; }

  [[nodiscard]] const std::shared_ptr<const StretchProgram>& program() const { return program_; }

 private:
  std::shared_ptr<const StretchProgram> program_;
  mutable std::once_flag tree_made_;
  mutable std::unique_ptr<const PathTree> tree_;  ///< made when a distance is asked for first
  mutable std::mutex mutex_;                      ///< of what is planned so far
  mutable StretchWalk walk_;
};

}  // namespace contour
