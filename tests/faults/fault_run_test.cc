#include "tools/faults/fault_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>

#include "tools/faults/campaign.h"
#include "tools/faults/proof.h"
#include "tools/faults/report.h"

namespace contour::faults {

/// What a test's name says of its parameter, instead of its bytes.
void PrintTo(const Supervisor& supervisor, std::ostream* out) { *out << Name(supervisor.watch); }

namespace {

EmulatedMachineFile Example() {
  return LoadEmulatedMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml");
}

FaultCase Case(Fault fault, Phase phase, double feed_mm_s, DriveMode mode = DriveMode::kCst) {
  FaultCase c;
  c.fault = fault;
  c.phase = phase;
  c.mode = mode;
  c.axis_name = "x";
  c.feed_mm_s = feed_mm_s;
  return c;
}

std::string All(const RunResult& r) {
  std::string text;
  for (const std::string& v : r.violations) text += v + "; ";
  return text;
}

TEST(FaultRun, TheSameRunGivesTheSameResult) {
  const EmulatedMachineFile file = Example();
  const FaultCase c = Case(Fault::kBusDown, Phase::kConstant, 100.0);
  const RunResult a = RunFault(c, {&file, 3});
  const RunResult b = RunFault(c, {&file, 3});
  EXPECT_TRUE(a.stopped);
  EXPECT_EQ(a.reason, Reason::kBusDown);
  EXPECT_GT(a.departure_m, 1e-5) << "a quick stop from 100 mm/s leaves the path's end behind";
  EXPECT_EQ(a.departure_m, b.departure_m);
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(All(a), "");
}

TEST(FaultRun, APausedOrHaltedProgramHasMovedBefore) {
  const EmulatedMachineFile file = Example();
  for (const Phase phase : {Phase::kPaused, Phase::kHalted}) {
    SCOPED_TRACE(Name(phase));
    const RunResult r = RunFault(Case(Fault::kLogBlocked, phase, 50.0), {&file, 1});
    EXPECT_EQ(All(r), "");
    EXPECT_GT(r.departure_m, 1e-7) << "friction has left the axis off its path";
    // Torque that is gone shows there, and stops the machine, as in motion.
    const RunResult lost = RunFault(Case(Fault::kDriveFault, phase, 50.0), {&file, 1});
    EXPECT_TRUE(lost.stopped);
    EXPECT_EQ(All(lost), "");
  }
}

TEST(FaultRun, ALostFrameStopsNothingInEitherMode) {
  const EmulatedMachineFile file = Example();
  for (const DriveMode mode : {DriveMode::kCst, DriveMode::kCsp}) {
    const RunResult r = RunFault(Case(Fault::kFeedbackFrameLost, Phase::kConstant, 50.0, mode), {&file, 1});
    EXPECT_FALSE(r.stopped);
    EXPECT_EQ(All(r), "");
  }
}

/// Cases of the long campaign that once failed, with their feeds: the run follows from both.
struct OnceFailed {
  Fault fault;
  Phase phase;
  DriveMode mode;
  double feed_mm_s;
  const char* axis;
  const char* machine;
};

EmulatedMachineFile Machine(const char* name) {
  const std::string folder = std::string(name) == "xy_emulated" ? CONTOUR_CONFIG_DIR : CONTOUR_FAULT_MACHINES;
  return LoadEmulatedMachine(folder + "/" + name + ".yaml");
}

TEST(FaultRun, DrivesAndResetOnceFailed) {
  using enum Phase;
  using enum DriveMode;
  const OnceFailed cases[] = {
      // Another master's set-point comes last before SYNC: the drive never sees ours.
      {Fault::kForeignSetpoint, kReversal, kCst, 4.83, "x", "xy_emulated"},
      {Fault::kForeignSetpoint, kReversal, kCsp, 0.614, "x", "xy_emulated"},
      // After a long bring-up the machine was Idle before the drive's fault was gone.
      {Fault::kForeignSetpoint, kReset, kCst, 2.4, "y", "xy_emulated"},
      {Fault::kForeignSync, kReset, kCsp, 45.5, "y", "xy_emulated"},
      {Fault::kBusDown, kReset, kCsp, 0.105, "y", "heavy_table"},
      {Fault::kForeignNmt, kReset, kCsp, 0.642, "z", "light_axis"},
      // The drive says why only after what is seen of it.
      {Fault::kSetpointsLost, kReset, kCst, 2.69, "y", "xy_emulated"},
      {Fault::kSetpointsLost, kReset, kCst, 3.95, "z", "light_axis"},
      {Fault::kSetpointsLost, kAcceleration, kCsp, 338.0, "z", "light_axis"},
      // Nobody looked at the age of feedback before the torque was allowed.
      {Fault::kFeedbackFramesLate, kEnabling, kCst, 1.78, "x", "heavy_table"},
      // Enabled again before the axis was reported to be at rest: refused.
      {Fault::kEncoderJumpLarge, kConstant, kCst, 10.0, "x", "ton_table"},
  };
  for (const OnceFailed& once : cases) {
    const EmulatedMachineFile file = Machine(once.machine);
    FaultCase c = Case(once.fault, once.phase, once.feed_mm_s, once.mode);
    c.axis_name = once.axis;
    c.axis =
        static_cast<std::size_t>(std::distance(file.machine.axes.begin(), file.machine.axes.find(once.axis)));
    EXPECT_EQ(All(RunFault(c, {&file, 1})), "") << Key(c);
  }
}

// In its loops (cst) or behind them (csp): the axis goes on by its motor and stops on the path, and where a
// scale at rest is not missed it has to be seen once the axis moves.
TEST(FaultRun, AScaleThatFailsNeverTurnsIntoMotion) {
  const EmulatedMachineFile file = Machine("scaled");
  for (const Fault fault :
       {Fault::kScaleSilent, Fault::kScaleFrozen, Fault::kScaleReversed, Fault::kScaleJump})
    for (const Phase phase : {Phase::kEnabling, Phase::kReady, Phase::kConstant, Phase::kReversal})
      for (const double feed_mm_s : {0.02, 1.0, 50.0})
        for (const DriveMode mode : {DriveMode::kCst, DriveMode::kCsp}) {
          if (!Moves(phase) && feed_mm_s > 0.02) continue;
          const FaultCase c = Case(fault, phase, feed_mm_s, mode);
          const RunResult r = RunFault(c, {&file, 1});
          EXPECT_EQ(All(r), "") << Key(c) << " " << feed_mm_s;
          // Readings that contradict the motor displace the axis by what they may be off by, or are braked.
          EXPECT_LT(r.departure_m, 0.6e-3) << Key(c) << " " << feed_mm_s;
          // At a crawl it takes longer to show than a run lasts.
          if (phase == Phase::kConstant && feed_mm_s >= 1.0) {
            EXPECT_TRUE(r.stopped) << Key(c) << " " << feed_mm_s;
          }
        }
}

// Two per cent of the travel from some instant on. Before, at speed, the loop followed such a scale to 0.67
// mm.
TEST(FaultRun, AScaleOrAnEncoderThatCountsLessIsSeenBeforeTheLoopHasFollowedItFar) {
  const EmulatedMachineFile file = LoadEmulatedMachine(std::string(CONTOUR_CONFIG_DIR) + "/family/t30s.yaml");
  for (const Fault fault : {Fault::kScaleCountsLess, Fault::kEncoderCountsLess})
    for (const double feed_mm_s : {10.0, 50.0, 144.0, 235.0})
      for (const DriveMode mode : {DriveMode::kCst, DriveMode::kCsp}) {
        const FaultCase c = Case(fault, Phase::kConstant, feed_mm_s, mode);
        const RunResult r = RunFault(c, {&file, 1});
        EXPECT_EQ(All(r), "") << Key(c) << " " << feed_mm_s;
        EXPECT_TRUE(r.stopped) << Key(c) << " " << feed_mm_s;
        if (fault == Fault::kScaleCountsLess) {
          // The stop's own travel is in it. 0.23, 0.63 and 0.71 mm before.
          EXPECT_LT(r.departure_m, feed_mm_s < 200.0 ? 0.4e-3 : 0.65e-3) << Key(c) << " " << feed_mm_s;
        }
      }
}

// Nothing of it may stop an axis whose scale is sound.
TEST(FaultRun, ALostSetpointOrALateSyncIsNoFaultOfTheScale) {
  const EmulatedMachineFile file = Machine("scaled");
  for (const Fault fault : {Fault::kSetpointLost, Fault::kBusTraffic})
    for (const double feed_mm_s : {17.4, 37.0, 144.0, 227.0})
      for (const DriveMode mode : {DriveMode::kCst, DriveMode::kCsp}) {
        const FaultCase c = Case(fault, Phase::kConstant, feed_mm_s, mode);
        EXPECT_EQ(All(RunFault(c, {&file, 3102})), "") << Key(c) << " " << feed_mm_s;
      }
}

class WithoutSupervisor : public ::testing::TestWithParam<Supervisor> {};

/// The campaign on the fault that the supervisor is there for: holds with it, fails without it.
TEST_P(WithoutSupervisor, TheCampaignFails) {
  const Proof proof = Prove(GetParam(), Example(), 1, 2);
  EXPECT_TRUE(proof.holds()) << ProofsMarkdown({proof});
}

TEST(FaultRun, EachSupervisorHasAProof) {
  for (std::size_t i = 0; i < kWatchCount; ++i)
    EXPECT_NE(FindSupervisor(Name(static_cast<Watch>(i))), nullptr) << i;
}

INSTANTIATE_TEST_SUITE_P(Each, WithoutSupervisor, ::testing::ValuesIn(Supervisors()),
                         [](const auto& one) { return std::string(Name(one.param.watch)); });

TEST(FaultRun, ThreadsChangeNothing) {
  const EmulatedMachineFile file = Example();
  PlanRequest plan;
  plan.runs = 12;
  plan.only = {"feedback_frame_late", "drive_fault", "bus_down"};
  const std::vector<FaultCase> cases = Plan(plan, {{"x", 250.0}, {"y", 250.0}});
  const std::string one = RunsCsv(RunCampaign(cases, {&file, 1}, 1));
  EXPECT_EQ(one, RunsCsv(RunCampaign(cases, {&file, 1}, 3)));
  EXPECT_GT(std::count(one.begin(), one.end(), '\n'), 12);
}

}  // namespace
}  // namespace contour::faults
