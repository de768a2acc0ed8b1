#pragma once

#include <vector>

#include "daemon/program/motion_plan.h"
#include "tools/faults/test_path.h"

namespace contour::faults {

/// The motion of a run as a program has it, for runs in which its pace changes: the points of a TestPath, and
/// between them what a quintic makes of them.
class TestPlan final : public MotionPlan {
 public:
  TestPlan(TestPath path, double period_s);

  [[nodiscard]] std::size_t axis_count() const override { return points_.front().size(); }
  [[nodiscard]] double duration_s() const override {
    return static_cast<double>(points_.size() - 1) * period_s_;
  }
  void At(double time_s, PerAxis<ReferencePoint>& axes) const override;
  /// At its end, as M0 in the last line has it.
  [[nodiscard]] std::uint32_t Halts(double time_s) const override { return time_s >= duration_s() ? 1 : 0; }
  [[nodiscard]] double Distance_m(const PerAxis<double>& /*point_m*/) const override { return 0.0; }
  [[nodiscard]] double Turns(double /*time_s*/) const override { return 0.0; }
  [[nodiscard]] bool Scored(double /*time_s*/) const override { return false; }
  [[nodiscard]] std::optional<CommandedCircle> circle() const override { return std::nullopt; }
  [[nodiscard]] bool is_hold() const override { return false; }
  [[nodiscard]] bool Moves(std::size_t /*axis*/) const override { return true; }

 private:
  double period_s_;
  std::vector<PerAxis<ReferencePoint>> points_;
};

}  // namespace contour::faults
