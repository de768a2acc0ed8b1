#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/cycle_input.h"
#include "daemon/program/motion_plan.h"

namespace contour::test {

/// Takes the points that the cycle would follow and says by how much they exceed the axes' limits: velocity,
/// acceleration and jerk by the differences of the positions, jerk by that of the accelerations handed out as
/// well, 1 at the limit.
class LimitWatch {
 public:
  LimitWatch(const PerAxis<PlanLimits>& limits, double period_s) : limits_(limits), period_s_(period_s) {}

  void Add(const PerAxis<ReferencePoint>& axes) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
      std::array<double, 4>& p = last_[i];
      std::rotate(p.begin(), p.begin() + 1, p.end());
      p[3] = axes[i].position_m;
      if (count_ == 0) p.fill(p[3]);
      const double h = period_s_;
      const PlanLimits& l = limits_[i];
      velocity_ = std::max(velocity_, std::abs(p[3] - p[2]) / h / l.velocity_m_s);
      acceleration_ =
          std::max(acceleration_, std::abs(p[3] - 2 * p[2] + p[1]) / (h * h) / l.acceleration_m_s2);
      if (l.jerk_m_s3 > 0.0)
        jerk_ = std::max(jerk_, std::abs(p[3] - 3 * p[2] + 3 * p[1] - p[0]) / (h * h * h) / l.jerk_m_s3);
      if (l.jerk_m_s3 > 0.0 && count_ > 0)
        jerk_ =
            std::max(jerk_, std::abs(axes[i].acceleration_m_s2 - acceleration_m_s2_[i]) / h / l.jerk_m_s3);
      // Velocity and acceleration handed out belong to the positions.
      if (count_ > 1) {
        const double central = (p[3] - p[1]) / (2 * h);
        wrong_velocity_ = std::max(wrong_velocity_, std::abs(central - velocity_m_s_[i]) / l.velocity_m_s);
        const double second = (p[3] - 2 * p[2] + p[1]) / (h * h);
        wrong_acceleration_ =
            std::max(wrong_acceleration_, std::abs(second - acceleration_m_s2_[i]) / l.acceleration_m_s2);
      }
      velocity_m_s_[i] = axes[i].velocity_m_s;
      acceleration_m_s2_[i] = axes[i].acceleration_m_s2;
    }
    ++count_;
  }

  void ExpectKept(double within = 1.0101) const {
    EXPECT_LE(velocity_, within);
    EXPECT_LE(acceleration_, within);
    EXPECT_LE(jerk_, within);
    EXPECT_LE(wrong_velocity_, 0.02);
    EXPECT_LE(wrong_acceleration_, 0.1);
  }
  [[nodiscard]] double jerk() const { return jerk_; }
  [[nodiscard]] double acceleration() const { return acceleration_; }

 private:
  PerAxis<PlanLimits> limits_;
  double period_s_;
  std::array<std::array<double, 4>, kMaxAxes> last_{};
  std::array<double, kMaxAxes> velocity_m_s_{};
  std::array<double, kMaxAxes> acceleration_m_s2_{};
  long count_ = 0;
  double velocity_ = 0.0, acceleration_ = 0.0, jerk_ = 0.0;
  double wrong_velocity_ = 0.0, wrong_acceleration_ = 0.0;
};

}  // namespace contour::test
