#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "daemon/path_feeder.h"
#include "daemon/program/gcode/program_halts.h"
#include "tests/daemon/path_consumer.h"
#include "tests/daemon/program/keeps_limits.h"

namespace contour::test {

inline constexpr double kTolerance_m = 1e-5;

inline PerAxis<PlanLimits> WithTolerance(PerAxis<PlanLimits> limits) {
  for (PlanLimits& l : limits) l.path_tolerance_m = kTolerance_m;
  return limits;
}

/// A program on its way from the supply to the cycle.
class Way {
 public:
  Way(const std::string& text, const PerAxis<PlanLimits>& limits, const PacedPath::Options& options = {},
      ProgramFormat format = ProgramFormat::kGcode, std::size_t queue = 4096)
      : mailbox_(16, queue), feeder_(mailbox_), consumer_(mailbox_, 120.0), watch_(limits, kPeriod_s) {
    Program program = ParseProgram(text, "program of the test", format);
    if (options.halts)
      UseEvents(std::get<GcodeMoves>(program.shape), program.name, EventUse{true, {}, {}, true});
    feeder_.Begin(std::make_unique<PathGenerator>(program, Origin(), limits, kPeriod_s, 1), options);
    plan_ = feeder_.path()->generator().plan();
  }
  PathFeeder& feeder() { return feeder_; }
  Consumer& consumer() { return consumer_; }
  [[nodiscard]] const MotionPlan& plan() const { return *plan_; }
  [[nodiscard]] bool ended() { return consumer_.follower().at_end(); }
  [[nodiscard]] ProgramPlace place() { return consumer_.follower().program_place(); }
  [[nodiscard]] const LimitWatch& watch() const { return watch_; }
  [[nodiscard]] double off_m() const { return off_m_; }
  [[nodiscard]] int cycles() const { return cycles_; }

  void Cycle(bool feed = true, bool tell = true) {
    if (feed) feeder_.Feed();
    consumer_.Tick(tell);
    const PerAxis<ReferencePoint> now = consumer_.Now();
    watch_.Add(now);
    PerAxis<double> at_m;
    for (const ReferencePoint& p : now) at_m.push_back(p.position_m);
    off_m_ = std::max(off_m_, plan_->Distance_m(at_m));
    ++cycles_;
  }
  void Run(int most) {
    for (int i = 0; i < most && !ended(); ++i) Cycle();
  }
  void ExpectAtItsEnd() {
    PerAxis<ReferencePoint> end;
    plan_->At(plan_->duration_s(), end);
    const PerAxis<ReferencePoint> now = consumer_.Now();
    for (std::size_t i = 0; i < now.size(); ++i) {
      EXPECT_NEAR(now[i].position_m, end[i].position_m, 1e-11);
      EXPECT_EQ(now[i].velocity_m_s, 0.0);
    }
  }

 private:
  CommandMailbox mailbox_;
  PathFeeder feeder_;
  Consumer consumer_;
  std::shared_ptr<const MotionPlan> plan_;
  LimitWatch watch_;
  double off_m_ = 0.0;
  int cycles_ = 0;
};

}  // namespace contour::test
