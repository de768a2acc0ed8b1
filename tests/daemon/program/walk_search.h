#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "daemon/program/motion_plan.h"
#include "tests/daemon/program/keeps_limits.h"
#include "tests/daemon/program/part_programs.h"

namespace contour::testing {

/// A machine, a program, and changes of its feed at any time, holds among them: all of it from one number.
class WalkSearch {
 public:
  explicit WalkSearch(unsigned seed) : random_(seed) {
    const double velocity = std::pow(10.0, Between(-1.5, 0.0)),
                 acceleration = std::pow(10.0, Between(-0.3, 1.3));
    const double rise_s = std::pow(10.0, Between(-2.3, -0.7)),
                 tolerance_m = std::pow(10.0, Between(-5.7, -4.0));
    for (const char* axis : {"x", "y"}) {
      PlanLimits l;
      l.axis = axis;
      l.position_min_m = -10.0;
      l.position_max_m = 10.0;
      l.velocity_m_s = velocity * Between(0.5, 1.0);
      l.acceleration_m_s2 = acceleration * Between(0.5, 1.0);
      l.jerk_m_s3 = acceleration / rise_s * Between(0.5, 1.0);
      l.path_tolerance_m = tolerance_m;
      limits_.push_back(l);
    }
    PerAxis<double> start_m(2);
    start_m[0] = start_m[1] = 0.0;
    plan_ = PlanMotion(ParseProgram(Text(), "any.ngc", ProgramFormat::kGcode), start_m, limits_);
  }

  /// `least`: of the feeds; below 0 there are holds, too.
  void Run(double least) {
    const double duration_s = plan_->duration_s();
    if (duration_s > 30.0) return;
    const auto walk = plan_->Walk();
    test::LimitWatch watch(limits_, kPeriod_s);
    double next_s = Between(0.0, std::min(1.0, duration_s)), off_m = 0.0, last_s = 20.0 * duration_s + 60.0;
    int changes = 0;
    bool held = false;
    PerAxis<ReferencePoint> at;
    double t = 0.0;
    for (long k = 0; t < last_s; ++k) {
      t = kPeriod_s * static_cast<double>(k);
      if (t >= next_s && changes <= kChanges) {
        const bool hold = least < 0.0 && !held && changes < kChanges && Between(0.0, 1.0) < 0.4;
        held = hold;
        const double feed = hold ? 0.0 : changes == kChanges ? 1.0 : Between(std::max(least, 0.03), 2.0);
        walk->ChangeFeed(t, feed);
        ++changes;
        next_s = t + (Between(0.0, 1.0) < 0.3 ? Between(0.0, 0.03)
                                              : Between(0.0, std::max(0.3, 0.2 * duration_s)));
      }
      walk->At(t, at);
      watch.Add(at);
      PerAxis<double> place_m;
      for (const ReferencePoint& p : at) place_m.push_back(p.position_m);
      off_m = std::max(off_m, plan_->Distance_m(place_m));
      if (!walk->GoesOnAfter(t)) break;
    }
    EXPECT_LT(t, last_s) << "it ends";
    EXPECT_LE(off_m, limits_[0].path_tolerance_m);
    watch.ExpectKept(least < 0.0 ? kKeptInHolds : kKept);
    PerAxis<ReferencePoint> end;
    plan_->At(duration_s, end);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(at[i].position_m, end[i].position_m, 1e-11);
  }

 private:
  static constexpr double kPeriod_s = 1e-3;
  static constexpr int kChanges = 14;
  static constexpr double kKept = 1.02;
  // A stop on the way may use a little more each time.
  static constexpr double kKeptInHolds = 1.04;

  double Between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967295.0;
  }
  std::string Text() {
    const double feed = std::pow(10.0, Between(2.5, 4.3));
    switch (random_() % 7) {
      case 0:
        return ChordCircle(Between(0.5, 10.0), Between(0.02, 0.5), 3, feed);
      case 1:
        return Spiral(3, 0.8, Between(0.05, 0.5), 3, feed);
      case 2:
        return EngravedText(static_cast<unsigned>(random_()), 4, Between(0.03, 0.3), 3, feed);
      case 3:
        return Pocket(3, feed);
      case 4:
        return RapidZigzag(6);
      case 5:
        return "F" + std::to_string(feed) + "\nG1 X20\nG3 Y10 J5\nG1 X0\nG3 Y0 J-5\nG1 X20\n";
      default:
        return AnyMoves(static_cast<unsigned>(random_()), 30);
    }
  }

  std::mt19937 random_;
  PerAxis<PlanLimits> limits_;
  std::shared_ptr<const MotionPlan> plan_;
};

}  // namespace contour::testing
