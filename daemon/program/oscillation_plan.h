#pragma once

#include <string>
#include <vector>

#include "daemon/program/motion_plan.h"

namespace contour {

/// Multisine and sweep: one axis oscillates about where it stands, faded in and out so that it begins and
/// ends at rest.
class OscillationPlan : public MotionPlan {
 public:
  /// Both throw ProgramError when the motion leaves the axis's limits; `origin` begins the message.
  OscillationPlan(const MultisineShape& shape, std::size_t axis, const PerAxis<double>& start_m,
                  const PerAxis<PlanLimits>& limits, const std::string& origin);
  OscillationPlan(const SweepShape& shape, std::size_t axis, const PerAxis<double>& start_m,
                  const PerAxis<PlanLimits>& limits, const std::string& origin);

  [[nodiscard]] std::size_t axis_count() const override { return start_m_.size(); }
  [[nodiscard]] double duration_s() const override { return duration_s_; }
  void At(double time_s, PerAxis<ReferencePoint>& axes) const override;
  [[nodiscard]] double Distance_m(const PerAxis<double>& point_m) const override;
  [[nodiscard]] double Turns(double) const override { return 0.0; }
  [[nodiscard]] bool Scored(double time_s) const override { return time_s >= 1.0 && time_s <= duration_s_; }
  [[nodiscard]] std::optional<CommandedCircle> circle() const override { return std::nullopt; }
  [[nodiscard]] bool is_hold() const override { return false; }
  [[nodiscard]] bool Moves(std::size_t axis) const override { return axis == axis_; }

 private:
  struct Line {
    double amplitude_m = 0.0;
    double rate_rad_s = 0.0;
    double phase_rad = 0.0;
  };

  void CheckLimits(const PlanLimits& limits, double highest_hz, const std::string& origin);
  [[nodiscard]] ReferencePoint Oscillation(double time_s) const;

  PerAxis<double> start_m_;
  std::size_t axis_;
  double duration_s_;
  double fade_s_;
  std::vector<Line> lines_;    ///< multisine
  double velocity_m_s_ = 0.0;  ///< sweep: amplitude of the velocity
  double first_rad_s_ = 0.0;   ///< sweep: rate at the start
  double growth_1_s_ = 0.0;    ///< sweep: the rate grows as exp(growth t)
  double lowest_m_ = 0.0;      ///< of the moving axis
  double highest_m_ = 0.0;
};

}  // namespace contour
