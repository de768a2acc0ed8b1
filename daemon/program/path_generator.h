#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "core/cycle_input.h"
#include "daemon/program/motion_plan.h"
#include "daemon/program/path_offsets.h"

namespace contour {

/// Hands out a program's reference one grid point at a time. Point 0 is the start position at rest; the last
/// point is flagged and at rest. Computes each point when it is asked for, so programs of any length start at
/// once. Not for the real-time thread.
class PathGenerator {
 public:
  /// Of a period. What is a whole number of them but for that does not get another point.
  static constexpr double kRounding = 1e-6;

  /// Throws ProgramError when the program does not fit the machine (see PlanMotion).
  PathGenerator(const Program& program, const PerAxis<double>& start_m, const PerAxis<PlanLimits>& limits,
                double period_s, std::uint32_t program_id);

  /// Of a program that is placed already.
  PathGenerator(std::shared_ptr<const MotionPlan> plan, const PerAxis<PlanLimits>& limits, double period_s,
                std::uint32_t program_id);

  /// Hand the points out shifted from now on; null: as they are.
  void Shift(std::shared_ptr<const PathOffsets> offsets) { offsets_ = std::move(offsets); }

  /// The next grid point; false when the last one has been handed out.
  bool Next(PathPoint& point);

  [[nodiscard]] const PerAxis<PlanLimits>& limits() const { return limits_; }
  [[nodiscard]] double period_s() const { return period_s_; }
  [[nodiscard]] std::uint32_t program_id() const { return program_id_; }
  [[nodiscard]] const std::shared_ptr<const PathOffsets>& offsets() const { return offsets_; }
  /// So many that a time is not longer than they are.
  [[nodiscard]] std::uint64_t PeriodsIn(double time_s) const;
  /// Altogether; plans all of the program.
  [[nodiscard]] std::uint64_t points() const;
  [[nodiscard]] std::uint64_t points_done() const { return next_; }
  [[nodiscard]] double duration_s() const { return plan_->duration_s(); }
  /// Can its feed be more than the programmed one? A shift that was learnt belongs to the program's own time.
  [[nodiscard]] bool feed_may_exceed() const { return plan_->feed_may_change() && !offsets_; }
  [[nodiscard]] const std::shared_ptr<const MotionPlan>& plan() const { return plan_; }

 private:
  std::shared_ptr<const MotionPlan> plan_;
  PerAxis<PlanLimits> limits_;
  double period_s_;
  std::uint32_t program_id_;
  bool done_ = false;
  std::uint64_t next_ = 0;
  std::shared_ptr<const PathOffsets> offsets_;
};

}  // namespace contour
