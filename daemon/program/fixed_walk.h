#pragma once

#include <limits>
#include <memory>
#include <utility>

#include "daemon/program/motion_plan.h"
#include "daemon/program/path_walk.h"

namespace contour {

/// Along a plan whose feed is fixed.
class FixedWalk : public PathWalk {
 public:
  explicit FixedWalk(std::shared_ptr<const MotionPlan> plan) : plan_(std::move(plan)) {}

  void At(double time_s, PerAxis<ReferencePoint>& axes) override { plan_->At(time_s, axes); }
  [[nodiscard]] bool GoesOnAfter(double time_s) override { return plan_->GoesOnAfter(time_s); }
  double ChangeFeed(double time_s, double) override { return time_s; }
  [[nodiscard]] double rests_from_s() const override { return std::numeric_limits<double>::infinity(); }
  [[nodiscard]] int Line(double time_s) override { return static_cast<int>(plan_->Line(time_s)); }
  [[nodiscard]] std::uint32_t Halts(double time_s) override { return plan_->Halts(time_s); }
  [[nodiscard]] double ProgramTime_s(double time_s) override { return time_s; }
  [[nodiscard]] double duration_s() override { return plan_->duration_s(); }
  [[nodiscard]] double TimeShare(double /*time_s*/) override { return 1.0; }
  [[nodiscard]] Estimate ProgramDuration() override { return {plan_->duration_s(), true}; }
  [[nodiscard]] double planned_s() override { return std::numeric_limits<double>::infinity(); }
  void PlanStep() override {}
  void ForgetBefore(double) override {}
  [[nodiscard]] std::unique_ptr<PathWalk> Clone() const override {
    return std::make_unique<FixedWalk>(plan_);
  }

 private:
  std::shared_ptr<const MotionPlan> plan_;
};

}  // namespace contour
