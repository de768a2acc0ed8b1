#include <gtest/gtest.h>

#include <array>
#include <string>

#include "daemon/reason_text.h"
#include "tests/closed_loop/test_machine.h"

namespace contour::test {
namespace {

// A host that does not let the cycle run for some periods: nothing is sent, the drives hold the last torque
// and time goes on for the plant.
class SkippedGridPoints : public ::testing::Test {
 protected:
  SkippedGridPoints() : machine_(ExampleMachine(), ControllerName::kFull, EmulatedClock::kWall) {
    machine_.BringUp();
    machine_.Enable();
    machine_.Start(Circle(10.0, 3, 0.7957747155));  // 3 m/min
    for (int i = 0; i < 3000 && machine_.record().path_time_s < 1.5; ++i) machine_.Tick();
  }
  double LargestFollowingError_m() {
    double largest = 0.0;
    for (const AxisRecord& a : machine_.record().axes)
      largest = std::max(largest, std::abs(a.following_error_m));
    return largest;
  }

  VirtualMachine machine_;
};

TEST_F(SkippedGridPoints, AFewAreCaughtUpWith) {
  ASSERT_EQ(machine_.record().state, MachineState::kRunning);
  double worst_m = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const bool hiccup = i % 100 == 50;
    const int count = 1 + i / 100 % 2;
    const double before_s = machine_.record().path_time_s;
    if (hiccup) machine_.SkipGridPoints(static_cast<std::uint64_t>(count));
    machine_.Tick();
    ASSERT_EQ(machine_.record().state, MachineState::kRunning) << "in cycle " << i;
    if (hiccup) {
      EXPECT_NEAR(machine_.record().path_time_s - before_s, 1e-3 * (1 + count), 1e-9)
          << "the path keeps its time";
    }
    worst_m = std::max(worst_m, LargestFollowingError_m());
  }
  // A period is 50 um of way at this speed; the wind-up of the screw is 2 um.
  EXPECT_LT(worst_m, 15e-6);
}

TEST_F(SkippedGridPoints, AsManyAsFeedbackMayBeOldAreAFault) {
  ASSERT_EQ(machine_.record().state, MachineState::kRunning);
  machine_.SkipGridPoints(3);
  machine_.Tick();
  EXPECT_EQ(machine_.record().state, MachineState::kFaulted);
  EXPECT_EQ(machine_.record().reason, Reason::kGridPointsSkipped);
  for (const AxisRecord& a : machine_.record().axes) EXPECT_EQ(a.torque_Nm, 0.0);
}

// As after SIGSTOP and SIGCONT. The drives lost their master, stopped by themselves and are silent: that they
// did not end their quick stops, nobody has seen.
TEST_F(SkippedGridPoints, AProcessThatWasStoppedBlamesNoDrive) {
  machine_.SkipGridPoints(500);
  for (int i = 0; i < 1500; ++i) machine_.Tick();
  EXPECT_EQ(machine_.record().reason, Reason::kGridPointsSkipped);
  const std::string text =
      ReasonText(machine_.record(), machine_.axis_names(), std::array<std::string, 1>{"main"});
  EXPECT_NE(text.find("no cycle ran for 501 ms"), std::string::npos) << text;
  EXPECT_NE(text.find("SIGSTOP"), std::string::npos) << text;
  EXPECT_NE(text.find("axis x sent emergency code 0x8130"), std::string::npos) << text;
  EXPECT_EQ(text.find("did not end its quick stop"), std::string::npos) << text;
}

// Before: the observer of two inertias took what came after four periods for what one had brought, and swung.
TEST(SkippedGridPointsAtRest, DoNoHarm) {
  for (const char* law : {"control.friction=srukf", "control.friction=linear"}) {
    VirtualMachine machine(ExampleMachine({law}), ControllerName::kFull, EmulatedClock::kWall);
    machine.BringUp();
    machine.Enable();
    for (int i = 0; i < 1000; ++i) {
      machine.SkipGridPoints(static_cast<std::uint64_t>(i % 4));
      machine.Tick();
      ASSERT_EQ(machine.record().state, MachineState::kReady) << law << Name(machine.record().reason);
    }
    for (const AxisRecord& a : machine.record().axes) EXPECT_LT(std::abs(a.following_error_m), 0.2e-6) << law;
  }
}

}  // namespace
}  // namespace contour::test
