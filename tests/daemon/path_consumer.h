#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include "daemon/path_feeder.h"
#include "daemon/rt/path_follower.h"

namespace contour::test {

inline constexpr double kPeriod_s = 1e-3;

inline PerAxis<PlanLimits> Limits(double velocity_m_s, double acceleration_m_s2, double jerk_m_s3) {
  PerAxis<PlanLimits> limits;
  limits.push_back({"x", -1.0, 1.0, velocity_m_s, acceleration_m_s2, jerk_m_s3});
  limits.push_back({"y", -1.0, 1.0, 0.7 * velocity_m_s, 0.8 * acceleration_m_s2, 0.6 * jerk_m_s3});
  return limits;
}

inline PerAxis<double> Origin() {
  PerAxis<double> origin;
  origin.push_back(0.0);
  origin.push_back(0.0);
  return origin;
}

/// The cycle's side of the mailbox, and nothing else of the cycle.
class Consumer {
 public:
  Consumer(CommandMailbox& mailbox, double stop_periods) : mailbox_(mailbox) {
    follower_ = std::make_unique<PathFollower>(PerAxis<StopLimits>(2), kPeriod_s, stop_periods, 48);
    follower_->Hold(Origin());
    follower_->Expect(1);
  }
  /// One cycle; begins to move when enough is there. What the supply hears of it may be old.
  void Tick(bool tell = true) {
    if (tell) mailbox_.TellProgress(follower_->progress());
    PathPoint point;
    for (std::size_t i = std::min<std::size_t>(8, follower_->Room()); i > 0 && mailbox_.TakePathPoint(point);
         --i)
      follower_->Accept(point);
    if (!follower_->moving() && follower_->Prefetched()) follower_->Start();
    follower_->Advance();
    if (follower_->running_dry()) ++dry_;
  }
  [[nodiscard]] PerAxis<ReferencePoint> Now() const {
    PerAxis<ReferencePoint> now;
    for (std::size_t i = 0; i < 2; ++i) now.push_back(follower_->Near(i, 0));
    return now;
  }
  PathFollower& follower() { return *follower_; }
  [[nodiscard]] int dry() const { return dry_; }

 private:
  CommandMailbox& mailbox_;
  std::unique_ptr<PathFollower> follower_;
  int dry_ = 0;
};

inline std::unique_ptr<PathGenerator> Generator(const std::string& text, const PerAxis<PlanLimits>& limits,
                                                ProgramFormat format = ProgramFormat::kYaml) {
  return std::make_unique<PathGenerator>(ParseProgram(text, "program of the test", format), Origin(), limits,
                                         kPeriod_s, 1);
}

}  // namespace contour::test
