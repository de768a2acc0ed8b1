#include "daemon/program/path_walk.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/daemon/program/motion_seen.h"
#include "tests/daemon/program/on_a_table.h"
#include "tests/daemon/program/part_programs.h"

// Feed that changes on the way: hold, resume, override.
namespace contour {
namespace {

using testing::Gcode;
using testing::MotionSeen;
using testing::PlanOf;
using testing::SeeMotion;
using testing::TableLimits;

/// A walk as a feeder would take it: a change takes effect from the point that is handed out next.
struct Change {
  double at_s, scale;
};

struct Walked {
  MotionSeen seen;
  PerAxis<ReferencePoint> end;
  std::vector<double> rests_s;
};

Walked WalkAlong(const MotionPlan& plan, const std::vector<Change>& changes, double cycle_s = 1e-3) {
  const auto walk = plan.Walk();
  std::vector<PerAxis<ReferencePoint>> points;
  std::size_t next = 0;
  Walked walked;
  for (;;) {
    const double t = static_cast<double>(points.size()) * cycle_s;
    if (next < changes.size() && t >= changes[next].at_s) {
      EXPECT_LT(walk->ChangeFeed(t, changes[next].scale), t + 0.1);
      if (changes[next].scale == 0.0) walked.rests_s.push_back(walk->rests_from_s() - t);
      ++next;
    }
    walk->At(t, points.emplace_back());
    if (!walk->GoesOnAfter(t) || points.size() > 100000) break;
  }
  walked.end = points.back();
  const auto at = [&](double t, PerAxis<ReferencePoint>& p) {
    p = points[std::min(points.size() - 1, static_cast<std::size_t>(std::lround(t / cycle_s)))];
  };
  walked.seen = SeeMotion(at, static_cast<double>(points.size()) * cycle_s, plan, TableLimits(), cycle_s);
  return walked;
}

void ExpectGood(const Walked& walked, const MotionPlan& plan, const std::string& what) {
  EXPECT_LT(walked.seen.velocity, 1.02) << what;
  EXPECT_LT(walked.seen.acceleration, 1.02) << what;
  EXPECT_LT(walked.seen.jerk, 1.03) << what;
  EXPECT_LT(walked.seen.off_path_m, 8e-6) << what;
  PerAxis<ReferencePoint> end;
  plan.At(plan.duration_s(), end);
  for (std::size_t i = 0; i < end.size(); ++i)
    EXPECT_NEAR(walked.end[i].position_m, end[i].position_m, 1e-12) << what;
}

TEST(PathWalk, WithoutChangesItIsThePlan) {
  const auto plan = PlanOf(Gcode(testing::EngravedText(2, 4, 0.1, 3, 1500)));
  const auto walk = plan->Walk();
  for (double t = 0.0; t < plan->duration_s() + 0.1; t += 0.0137) {
    PerAxis<ReferencePoint> a, b;
    plan->At(t, a);
    walk->At(t, b);
    EXPECT_EQ(a[0].position_m, b[0].position_m);
    EXPECT_EQ(walk->GoesOnAfter(t), plan->GoesOnAfter(t));
  }
}

TEST(PathWalk, HoldsAndResumesAnywhereWithinTheLimits) {
  for (const auto& program : testing::PartPrograms()) {
    if (program.name == "anything" || program.name == "text") continue;  // long; they are below
    const auto plan = PlanOf(Gcode(program.text));
    for (int k = 1; k < 4; ++k) {
      const double at_s = plan->duration_s() * k / 4.0;
      const Walked walked = WalkAlong(*plan, {{at_s, 0.0}, {at_s + 0.5, 1.0}});
      ExpectGood(walked, *plan, program.name + " held at " + std::to_string(at_s));
      EXPECT_LT(walked.rests_s[0], 0.25) << program.name << " at " << at_s;
    }
  }
}

// The last ramp begins at the very instant of a point.
TEST(PathWalk, AHoldWhereItHardlyMovesRestsThere) {
  const auto plan = PlanOf(Gcode("F3000\nG1 X60\n"));
  for (int k = 0; k < 80; k += 4) {
    const auto walk = plan->Walk();
    const double at_s = 1e-3 * k;
    PerAxis<ReferencePoint> before, after;
    walk->At(at_s, before);
    walk->ChangeFeed(at_s, 0.0);
    for (int later = 1; later < 300; ++later) {
      walk->At(at_s + 1e-3 * later, after);
      ASSERT_LE(after[0].position_m - before[0].position_m, 0.051e-3) << k << " " << later;
      before = after;
    }
    EXPECT_NEAR(after[0].velocity_m_s, 0.0, 1e-9) << k;
  }
}

TEST(PathWalk, FeedIsScaledWithinTheLimits) {
  const auto plan = PlanOf(Gcode("F3000\nG1 X60\nG1 Y20\nG1 X0\n"));
  for (const double scale : {0.1, 0.5, 1.5, 2.0}) {
    const Walked walked = WalkAlong(*plan, {{0.3, scale}});
    ExpectGood(walked, *plan, std::to_string(scale));
    if (scale > 1.0) {
      EXPECT_NEAR(walked.seen.fastest_m_s, 0.05 * scale, 0.002);
    }
  }
  const Walked slow = WalkAlong(*plan, {{0.0, 0.2}});
  EXPECT_NEAR(slow.seen.fastest_m_s, 0.01, 2e-4);
}

TEST(PathWalk, AnyChangesAtAnyTime) {
  std::mt19937 random(11);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
  };
  const auto programs = testing::PartPrograms();
  for (int run = 0; run < 5; ++run) {
    const auto& program = programs[static_cast<std::size_t>(run) % programs.size()];
    const auto plan = PlanOf(Gcode(program.text));
    std::vector<Change> changes;
    double t = 0.0;
    for (int k = 0; k < 6; ++k) {
      t += between(0.0, 0.4);
      changes.push_back({t, k == 5                    ? 1.0
                            : k % 2 == 0              ? between(0.2, 2.0)
                            : between(0.0, 1.0) < 0.5 ? 0.0
                                                      : 0.3});
    }
    ExpectGood(WalkAlong(*plan, changes), *plan, program.name + ", run " + std::to_string(run));
  }
}

TEST(PathWalk, ShapesOfTheirOwnHaveNone) {
  EXPECT_EQ(PlanOf(testing::Yaml("shape: circle\nradius_mm: 1\nfrequency_hz: 1\n"))->Walk(), nullptr);
}

}  // namespace
}  // namespace contour
