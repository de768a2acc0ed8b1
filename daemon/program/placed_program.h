#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/program/gcode/program_halts.h"
#include "daemon/program/motion_plan.h"
#include "daemon/program/part_of_program.h"

namespace contour {

/// Where a program is to be drawn and where the machine is now, in machine coordinates.
struct Placement {
  PerAxis<double> start_m;  ///< where the axes stand
  PerAxis<double> zero_m;   ///< where the program's coordinates count from

  /// Program zero where the machine stands.
  static Placement Here(const PerAxis<double>& start_m) { return {start_m, start_m}; }
  /// How far the machine stands from program zero.
  [[nodiscard]] double Off_m() const;
};

/// A program read for that place: what G-code means depends on where it starts. Throws ProgramError as
/// ParseProgram does.
struct ProgramSource {
  std::string_view text;
  std::string name;  ///< for messages
  ProgramFormat format = ProgramFormat::kYaml;
};
struct ReadOptions {
  bool referenced = false;  ///< machine coordinates mean something
  PartOfProgram part{};     ///< of G-code; a shape has no lines
  EventUse events{};        ///< of G-code, too
};
Program ReadPlaced(const ProgramSource& source, const Placement& place, const PerAxis<PlanLimits>& limits,
                   const ReadOptions& options = {});

/// The plan of a program that counts from a zero of its own. A shape begins at program zero: where the
/// machine stands elsewhere it goes there first, in a straight line, at a tenth of the speed that the axes
/// may have. G-code says itself where it goes first. Throws ProgramError as PlanMotion does.
std::shared_ptr<const MotionPlan> PlanPlaced(const Program& program, const Placement& place,
                                             const PerAxis<PlanLimits>& limits);

/// A straight line to where another plan begins, and then that plan. What is asked of the figure, its score
/// and its distance from a point, is asked of that plan alone.
class ApproachPlan : public MotionPlan {
 public:
  ApproachPlan(std::shared_ptr<const MotionPlan> approach, std::shared_ptr<const MotionPlan> figure)
      : approach_(std::move(approach)), figure_(std::move(figure)), begin_s_(approach_->duration_s()) {}

  [[nodiscard]] std::size_t axis_count() const override { return figure_->axis_count(); }
  [[nodiscard]] double duration_s() const override { return begin_s_ + figure_->duration_s(); }
  void At(double time_s, PerAxis<ReferencePoint>& axes) const override {
    return time_s < begin_s_ ? approach_->At(time_s, axes) : figure_->At(time_s - begin_s_, axes);
  }
  [[nodiscard]] std::uint32_t Line(double time_s) const override {
    return time_s < begin_s_ ? 0 : figure_->Line(time_s - begin_s_);
  }
  [[nodiscard]] double Distance_m(const PerAxis<double>& point_m) const override {
    return figure_->Distance_m(point_m);
  }
  [[nodiscard]] double Turns(double time_s) const override {
    return time_s < begin_s_ ? 0.0 : figure_->Turns(time_s - begin_s_);
  }
  [[nodiscard]] bool Scored(double time_s) const override {
    return time_s >= begin_s_ && figure_->Scored(time_s - begin_s_);
  }
  [[nodiscard]] std::optional<CommandedCircle> circle() const override { return figure_->circle(); }
  [[nodiscard]] bool is_hold() const override { return false; }
  [[nodiscard]] bool Moves(std::size_t axis) const override {
    return approach_->Moves(axis) || figure_->Moves(axis);
  }
  [[nodiscard]] bool GoesOnAfter(double time_s) const override {
    return time_s < begin_s_ || figure_->GoesOnAfter(time_s - begin_s_);
  }

 private:
  std::shared_ptr<const MotionPlan> approach_;
  std::shared_ptr<const MotionPlan> figure_;
  double begin_s_;
};

}  // namespace contour
