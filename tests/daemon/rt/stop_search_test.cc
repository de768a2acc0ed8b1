#include "daemon/rt/stop_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/stop_on_path.h"
#include "daemon/program/motion_plan.h"
#include "daemon/rt/path_follower.h"

namespace contour {
namespace {

using Kind = PathFollower::StopKind;

/// A machine, as far as a stop goes: period, limits of its axes, and the fixed ramp that follows from them.
struct Machine {
  double period_s = 1e-3;
  double velocity_m_s = 0.25, acceleration_m_s2 = 5.0, jerk_m_s3 = 200.0;
  std::size_t axes = 2;

  [[nodiscard]] double RampPeriods() const {
    return std::max(1.5 * velocity_m_s / acceleration_m_s2, std::sqrt(6.0 * velocity_m_s / jerk_m_s3)) /
           period_s;
  }
  [[nodiscard]] PerAxis<PlanLimits> Plan() const {
    PerAxis<PlanLimits> limits;
    for (const char* name : {"x", "y", "z", "u", "v", "w", "a", "b"})
      if (limits.size() < axes)
        limits.push_back({name, -0.2, 0.2, velocity_m_s, acceleration_m_s2, jerk_m_s3});
    return limits;
  }
  [[nodiscard]] PerAxis<StopLimits> Stop() const {
    PerAxis<StopLimits> limits;
    for (std::size_t i = 0; i < axes; ++i) limits.push_back({acceleration_m_s2, jerk_m_s3});
    return limits;
  }
};

/// Straight lines between places drawn at random.
std::string Polygon(std::uint32_t seed, const std::string& mode, int feed_mm_min,
                    const std::string& letters = "XY") {
  std::mt19937 draw(seed);
  std::uniform_real_distribution<double> place(-15.0, 15.0);
  std::ostringstream text;
  text << mode << '\n';
  for (int i = 0; i < 12; ++i) {
    text << "G1";
    for (const char letter : letters) text << ' ' << letter << place(draw);
    text << " F" << feed_mm_min << '\n';
  }
  text << "M2\n";
  return text.str();
}

std::vector<PathPoint> PointsOf(const MotionPlan& plan, double period_s) {
  std::vector<PathPoint> points;
  for (std::size_t k = 0; points.empty() || !points.back().last; ++k) {
    PathPoint p;
    p.program_id = 1;
    const double time_s = period_s * static_cast<double>(k);
    plan.At(time_s, p.axes);
    p.last = time_s >= plan.duration_s();
    points.push_back(p);
  }
  return points;
}

/// What became of a stop, in parts of the limits and in periods.
struct Stopped {
  double jerk = 0.0, acceleration = 0.0, speed_up = 0.0;
  double periods = 0.0, way = 0.0;
};

class Runner {
 public:
  Runner(const Machine& machine, const std::vector<PathPoint>& points)
      : machine_(machine),
        points_(points),
        follower_(
            std::make_unique<PathFollower>(machine.Stop(), machine.period_s, machine.RampPeriods(), 48)) {
    follower_->Hold(PerAxis<double>(machine.axes));
    follower_->Expect(1);
    Supply();
    follower_->Start();
  }
  void RunTo(std::size_t clock) {
    for (std::size_t k = 0; k <= clock; ++k) Tick();
  }
  void Supply() {
    while (next_ < points_.size() && follower_->Room() != 0) follower_->Accept(points_[next_++]);
  }
  void Tick() {
    follower_->Advance();
    Supply();
    follower_->SearchStop();
  }
  PathFollower& follower() { return *follower_; }

  /// Until it rests, or another stop is to begin.
  Stopped Stop(Kind kind, int shortest_after = -1) {
    Stopped s;
    PerAxis<double> before;
    for (std::size_t i = 0; i < machine_.axes; ++i) before.push_back(follower_->Near(i, 0).acceleration_m_s2);
    const double begin = follower_->path_time();
    double last = begin;
    follower_->BeginStop(kind);
    follower_->SearchStop();
    for (int k = 0; follower_->moving() && k < 5000; ++k) {
      if (k == shortest_after) follower_->BeginStop(Kind::kShortest);
      Tick();
      ++s.periods;
      for (std::size_t i = 0; i < machine_.axes; ++i) {
        const double now = follower_->Near(i, 0).acceleration_m_s2;
        s.jerk = std::max(s.jerk, std::abs(now - before[i]) / machine_.period_s / machine_.jerk_m_s3);
        s.acceleration = std::max(s.acceleration, std::abs(now) / machine_.acceleration_m_s2);
        before[i] = now;
      }
      s.speed_up = std::max(s.speed_up, follower_->path_time() - last);
      last = follower_->path_time();
    }
    EXPECT_TRUE(follower_->at_rest());
    s.way = last - begin;
    return s;
  }

 private:
  Machine machine_;
  const std::vector<PathPoint>& points_;
  std::unique_ptr<PathFollower> follower_;
  std::size_t next_ = 0;
};

std::vector<PathPoint> Planned(const Machine& machine, const std::string& text) {
  const PerAxis<double> start(machine.axes);
  const auto plan = PlanMotion(ParseProgram(text, "test.ngc", ProgramFormat::kGcode), start, machine.Plan());
  return PointsOf(*plan, machine.period_s);
}

/// Stops at random instants of a program, each held to the limits.
struct Lot {
  double fixed_ramp_jerk = 0.0;  ///< the largest of the fixed ramp at the same instants
  double periods = 0.0;          ///< mean
  double way = 0.0;
  double longest = 0.0, farthest = 0.0;
};
Lot StopAtRandom(const Machine& machine, const std::string& text, int stops) {
  const std::vector<PathPoint> points = Planned(machine, text);
  std::mt19937 draw(7);
  std::uniform_int_distribution<std::size_t> instant(1, points.size() - 20);
  Lot lot;
  for (int n = 0; n < stops; ++n) {
    const std::size_t at = instant(draw);
    Runner runner(machine, points);
    runner.RunTo(at);
    const Stopped s = runner.Stop(Kind::kWithinLimits);
    EXPECT_LE(s.jerk, StopSearch::kWithin + 1e-6) << text << "at " << at;
    EXPECT_LE(s.acceleration, StopSearch::kWithin) << text << "at " << at;
    EXPECT_LE(s.speed_up, 1.0 + 1e-6) << "never faster than the program";
    EXPECT_LE(s.periods, (stop_on_path::kSearches + stop_on_path::kLongest) * machine.RampPeriods() + 4.0);
    EXPECT_LE(s.way, (stop_on_path::kSearches + stop_on_path::kFarthest) * machine.RampPeriods() + 4.0);
    Runner fixed(machine, points);
    fixed.RunTo(at);
    lot.fixed_ramp_jerk = std::max(lot.fixed_ramp_jerk, fixed.Stop(Kind::kShortest).jerk);
    lot.longest = std::max(lot.longest, s.periods);
    lot.farthest = std::max(lot.farthest, s.way);
    lot.periods += s.periods / stops;
    lot.way += s.way / stops;
  }
  return lot;
}

TEST(StopSearch, KeepsTheLimitsInEveryCornerOfAPolygon) {
  const Machine machine;
  const int stops = std::getenv("CONTOUR_LONG_TESTS") != nullptr ? 2000 : 40;
  std::uint32_t seed = 1;
  Lot all;
  const std::vector<std::pair<std::string, int>> kinds{{"G64", 6000},     {"G64", 15000}, {"G64 P0.2", 12000},
                                                       {"G64 P1", 15000}, {"G61", 12000}, {"G61.1", 15000}};
  for (const auto& [mode, feed] : kinds) {
    const Lot lot = StopAtRandom(machine, Polygon(seed++, mode, feed), stops);
    all.longest = std::max(all.longest, lot.longest);
    all.farthest = std::max(all.farthest, lot.farthest);
    all.fixed_ramp_jerk = std::max(all.fixed_ramp_jerk, lot.fixed_ramp_jerk);
    all.periods += lot.periods / static_cast<double>(kinds.size());
    all.way += lot.way / static_cast<double>(kinds.size());
  }
  // In periods; of the fixed ramp 87 and 43, and the cycle or two until it begins.
  for (const auto& [name, value] :
       {std::pair{"periods", all.periods}, std::pair{"longest", all.longest}, std::pair{"way", all.way},
        std::pair{"farthest", all.farthest}, std::pair{"fixed_ramp_jerk", all.fixed_ramp_jerk}})
    RecordProperty(name, std::to_string(value));
  EXPECT_GT(all.fixed_ramp_jerk, 1.5) << "these corners are none where anything fits";
  // Ordinary stops are as long as before, on the whole.
  EXPECT_LT(all.periods, 1.15 * machine.RampPeriods());
  EXPECT_LT(all.way, 1.3 * 0.5 * machine.RampPeriods());
}

TEST(StopSearch, KeepsTheLimitsOfOtherMachines) {
  // Heavy and slow; a shorter period; many axes, whose law takes several cycles to look for.
  StopAtRandom({1e-3, 0.1, 1.0, 15.0}, Polygon(11, "G64 P0.1", 5000), 20);
  StopAtRandom({5e-4, 0.3, 10.0, 600.0}, Polygon(12, "G64", 15000), 20);
  StopAtRandom({1e-3, 0.25, 5.0, 200.0, 6}, Polygon(13, "G64 P0.1", 12000, "XYZUVW"), 20);
}

TEST(StopSearch, TakesTheFixedRampOnAStraightLine) {
  const Machine machine;
  const std::vector<PathPoint> points = Planned(machine, "G1 X150 F15000\nM2\n");
  Runner runner(machine, points), fixed(machine, points);
  runner.RunTo(400);
  fixed.RunTo(400);
  const Stopped s = runner.Stop(Kind::kWithinLimits), f = fixed.Stop(Kind::kShortest);
  // It is looked for when the cycle's frames have been sent.
  EXPECT_EQ(s.periods, f.periods + 1.0);
  EXPECT_NEAR(s.way, f.way + 1.0, 1e-9);
  EXPECT_NEAR(s.jerk, f.jerk, 1e-4);
}

TEST(StopSearch, AFaultOnTheWayToRestIsNotKeptWaiting) {
  const Machine machine;
  const std::vector<PathPoint> points = Planned(machine, Polygon(4, "G64 P1", 15000));
  bool sooner = false;
  for (std::size_t at = 50; at + 200 < points.size(); at += 37) {
    Runner gentle(machine, points);
    gentle.RunTo(at);
    const double alone = gentle.Stop(Kind::kWithinLimits).periods;
    for (const int after : {0, 3, 40}) {
      Runner runner(machine, points);
      runner.RunTo(at);
      const double periods = runner.Stop(Kind::kWithinLimits, after).periods;
      EXPECT_LE(periods, std::max(alone, after + machine.RampPeriods() + 4.0)) << at;
      EXPECT_LE(periods, after + machine.RampPeriods() + 4.0) << at;
      sooner = sooner || periods < alone;
    }
  }
  EXPECT_TRUE(sooner);
}

// With many axes and a long ramp the search ends well before the ramp that it found begins.
TEST(StopSearch, AFaultDoesNotWaitForARampThatIsStillToBegin) {
  Machine machine;
  machine.axes = 8;
  machine.jerk_m_s3 = 4.0;
  const std::vector<PathPoint> points = Planned(machine, "G1 X150 F15000\nM2\n");
  constexpr int kAfter = 5;
  Runner gentle(machine, points);
  gentle.RunTo(points.size() / 2);
  ASSERT_GT(gentle.Stop(Kind::kWithinLimits).periods, kAfter + machine.RampPeriods() + 4.0)
      << "it would wait";
  Runner runner(machine, points);
  runner.RunTo(points.size() / 2);
  EXPECT_LE(runner.Stop(Kind::kWithinLimits, kAfter).periods, kAfter + machine.RampPeriods() + 4.0);
}

TEST(StopSearch, StopsByTheFixedRampWhereNothingFits) {
  // A zigzag without any blend: no stop keeps the limits, and none is asked for what the path itself does.
  Machine machine;
  std::vector<PathPoint> points;
  for (int k = 0; k < 3000; ++k) {
    PathPoint p;
    p.program_id = 1;
    const double angle = 0.9 * k;
    p.axes.push_back({2e-5 * std::sin(angle), 0.0, 4.0 * std::sin(angle)});
    p.axes.push_back({1e-4 * k, 0.1, 0.0});
    points.push_back(p);
  }
  Runner runner(machine, points);
  runner.RunTo(500);
  EXPECT_LE(runner.Stop(Kind::kWithinLimits).periods,
            (1.0 + stop_on_path::kSearches) * machine.RampPeriods() + 4.0);
}

TEST(StopSearch, TheRampFromAnyPaceEndsAtRestAndDoesNotTurnBack) {
  const PathPace from{100.0, 0.6, -0.02};
  const double length = 3.0 * 0.6 / 0.02;
  double rate = from.rate, time = from.time;
  for (double since = 0.0; since <= length; since += 0.5) {
    const PathPace p = StopRamp(from, since, length);
    EXPECT_GE(p.rate, -1e-12);
    EXPECT_LE(p.rate, rate + 1e-12);
    EXPECT_NEAR(p.time, time + (since > 0.0 ? 0.25 * (rate + p.rate) : 0.0), 1e-4);
    rate = p.rate;
    time = p.time;
  }
  EXPECT_EQ(StopRamp(from, length, length).rate, 0.0);
}

}  // namespace
}  // namespace contour
