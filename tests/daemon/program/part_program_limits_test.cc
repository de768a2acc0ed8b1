#include <gtest/gtest.h>

#include "daemon/program/blended_runs.h"
#include "tests/daemon/program/motion_seen.h"
#include "tests/daemon/program/on_a_table.h"
#include "tests/daemon/program/part_programs.h"

// Programs that were not written for us, on machines that are not ours: no limit is exceeded, the path kept.
namespace contour {
namespace {

using testing::Gcode;
using testing::MotionSeen;
using testing::PartProgram;
using testing::Point;
using testing::SeeMotion;
using testing::TableLimits;

struct Machine {
  std::string name;
  PerAxis<PlanLimits> limits;
};

Machine MakeMachine(const std::string& name, const PlanLimits& x, const PlanLimits& y) {
  Machine machine{name, {}};
  machine.limits.push_back(x);
  machine.limits.push_back(y);
  machine.limits[0].axis = "x";
  machine.limits[1].axis = "y";
  return machine;
}

PlanLimits Axis(double velocity_m_s, double acceleration_m_s2, double jerk_m_s3, double tolerance_m = 1e-5) {
  PlanLimits l;
  l.position_min_m = -1.0;
  l.position_max_m = 1.0;
  l.velocity_m_s = velocity_m_s;
  l.acceleration_m_s2 = acceleration_m_s2;
  l.jerk_m_s3 = jerk_m_s3;
  l.path_tolerance_m = tolerance_m;
  return l;
}

/// The example machine, two of config/family, and what nobody has.
std::vector<Machine> Machines() {
  return {MakeMachine("table", Axis(0.25, 5, 200), Axis(0.25, 5, 200)),
          MakeMachine("gantry500", Axis(0.625, 1.87, 69.4), Axis(0.625, 1.87, 69.4)),
          MakeMachine("very low jerk", Axis(0.25, 5, 1), Axis(0.25, 5, 1)),
          MakeMachine("very different axes", Axis(0.5, 10, 1000, 2e-5), Axis(0.02, 0.3, 4)),
          MakeMachine("high jerk, coarse", Axis(1.0, 20, 20000, 5e-5), Axis(1.0, 20, 20000, 5e-5)),
          MakeMachine("no limit of jerk, fine", Axis(0.25, 5, 0, 1e-6), Axis(0.25, 5, 0, 1e-6))};
}

class PartPrograms : public ::testing::TestWithParam<int> {};

TEST_P(PartPrograms, KeepEveryLimitAndThePath) {
  const Machine machine = Machines()[static_cast<std::size_t>(GetParam())];
  double tolerance_m = std::min(machine.limits[0].path_tolerance_m, machine.limits[1].path_tolerance_m);
  int number = 0;
  for (const PartProgram& program : testing::PartPrograms()) {
    // All on the first machine, half of them on each of the others.
    if (GetParam() > 0 && (++number + GetParam()) % 2 == 0) continue;
    const std::string what = machine.name + ": " + program.name;
    const auto plan = PlanMotion(Gcode(program.text), Point(0.003, -0.004), machine.limits);
    const MotionSeen seen = SeeMotion(*plan, machine.limits);
    EXPECT_LT(seen.velocity, 1.02) << what;
    EXPECT_LT(seen.acceleration, 1.02) << what;
    EXPECT_LT(seen.jerk, 1.02) << what;
    EXPECT_LT(seen.off_path_m, program.tolerance_m > 0.0 ? program.tolerance_m : tolerance_m) << what;
    PerAxis<PlanLimits> exact = machine.limits;
    double jerk = 0.0;
    for (const PlanLimits& l : exact)
      jerk = std::max(jerk, l.jerk_m_s3 > 0.0 ? l.jerk_m_s3 : l.acceleration_m_s2 / 4e-3);
    // The trapezoid's error, and a feed that is stated exactly.
    EXPECT_LT(seen.mismatch_m_s, 1.5 * jerk * 1e-6 / 12) << what;
  }
}

INSTANTIATE_TEST_SUITE_P(Machines, PartPrograms, ::testing::Range(0, 6));

/// A screw that gives 20 um for what is not known of its table at full acceleration, 2 um for friction.
PerAxis<PlanLimits> OnASoftScrew() {
  PerAxis<PlanLimits> limits = TableLimits();
  for (std::size_t i = 0; i < 2; ++i) {
    limits[i].path_following_m = 3e-5;
    limits[i].inertia_doubt_s2 = 2e-5 / limits[i].acceleration_m_s2;
    limits[i].friction_doubt_m = 2e-6;
  }
  return limits;
}

TEST(FollowedShare, IsWhatAToleranceLeavesForInertia) {
  const PerAxis<PlanLimits> limits = OnASoftScrew();
  EXPECT_EQ(FollowedShare(5e-5, limits), 1.0);
  EXPECT_NEAR(FollowedShare(1e-5, limits), 5e-6 / 2e-5, 1e-12);
  EXPECT_NEAR(FollowedShare(1e-6, limits), 2e-6 / 2e-5, 1e-12) << "no better than friction lets it be";
  EXPECT_EQ(FollowedShare(1e-9, TableLimits()), 1.0) << "nothing is expected";
}

// Stretch by stretch: what is to be accurate has less of acceleration and jerk, and what need not be has all.
TEST(PartProgramLimits, ATightToleranceOnASoftScrewIsDrivenGently) {
  const PerAxis<PlanLimits> limits = OnASoftScrew();
  const std::string zigzag = "G0 X10\nY1\nX0\nY2\nX10\nY0\nX0\n";
  const auto seen = [&](const std::string& words) {
    return SeeMotion(*PlanMotion(Gcode(words), Point(0, 0), limits), limits);
  };
  const MotionSeen rough = seen("G64 P0.05\n" + zigzag), fine = seen("G64 P0.01\n" + zigzag);
  EXPECT_GT(rough.acceleration, 0.9);
  EXPECT_GT(rough.jerk, 0.9);
  EXPECT_LT(fine.acceleration, 0.255);
  EXPECT_GT(fine.acceleration, 0.23);
  EXPECT_LT(fine.jerk, 0.255);
  const MotionSeen both = seen("G64 P0.01\n" + zigzag + "G4 P0\nG64 P0.05\n" + zigzag);
  EXPECT_NEAR(both.duration_s, rough.duration_s + fine.duration_s, 0.05);
}

}  // namespace
}  // namespace contour
