// Between the plan of a program and its first cycle an operator may set another feed. The test plays the
// cycle: it says which state the machine is in and takes the points.
#include "daemon/pace_control.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "daemon/program/program.h"
#include "tests/daemon/path_consumer.h"

namespace contour {
namespace {

using test::Consumer;
using test::Generator;
using test::kPeriod_s;
using test::Limits;

class PaceControlTest : public ::testing::Test {
 protected:
  static TelemetryConfig Silent() {
    TelemetryConfig config;
    config.publish = false;
    return config;
  }
  static PaceRequest Feed(double percent) { return {.feed_percent = percent}; }
  Answer Change(const PaceRequest& request, MachineState state) {
    CycleRecord now;
    now.state = state;
    return pace_.Change(request, [&] { return now; });
  }
  void Begin(const std::string& gcode) {
    auto generator = Generator(gcode, Limits(0.5, 5.0, 200.0), ProgramFormat::kGcode);
    pace_.Begin("part.ngc", std::move(generator), {}, {});
  }
  /// The pace that the program has come to after so many cycles.
  double PaceAfter(int cycles) {
    Consumer consumer(mailbox_, 40);
    pump_.Start();
    for (int i = 0; i < cycles; ++i) {
      consumer.Tick();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    pump_.Finish();
    return consumer.follower().program_place().pace;
  }

  CommandMailbox mailbox_{16, 2048};
  TelemetryQueue queue_{4};
  TelemetryHub hub_{Silent(), 1000, {"x", "y"}, std::nullopt};
  Pump pump_{queue_, mailbox_, hub_, kPeriod_s, {"x", "y"}, {"main"}};
  PaceControl pace_{pump_};
};

constexpr const char* kLine = "F600\nG1 X100\n";  // 10 s

TEST_F(PaceControlTest, AFeedThatCameAfterThePlanIsAskedForYearsToo) {
  pace_.RefuseYears("part.ngc", 10.0);
  ASSERT_TRUE(Change(Feed(1e-8), MachineState::kReady).accepted) << "no program is there yet";
  EXPECT_THROW(Begin(kLine), ProgramError);
  ASSERT_TRUE(Change(Feed(100.0), MachineState::kReady).accepted);
  EXPECT_NO_THROW(Begin(kLine)) << "and nothing is left of the one that was refused";
}

TEST_F(PaceControlTest, AFeedThatComesBeforeTheCycleRunsTheProgramIsAskedOfThatProgram) {
  Begin(kLine);
  EXPECT_FALSE(Change(Feed(1e-8), MachineState::kReady).accepted);
  pace_.Begun();
  EXPECT_FALSE(Change(Feed(1e-8), MachineState::kRunning).accepted) << "the pump has not got to it yet";
  EXPECT_TRUE(Change(Feed(1e-8), MachineState::kReady).accepted) << "it is over";
}

TEST_F(PaceControlTest, AFeedThatComesBeforeTheCycleRunsTheProgramReachesIt) {
  Begin(kLine);
  EXPECT_TRUE(Change(Feed(50.0), MachineState::kReady).accepted);
  pace_.Begun();
  EXPECT_NEAR(PaceAfter(1500), 0.5, 1e-6);
}

TEST_F(PaceControlTest, SoDoesAPause) {
  EXPECT_FALSE(Change({.paused = true}, MachineState::kReady).accepted) << "there is nothing to pause";
  Begin(kLine);
  EXPECT_TRUE(Change({.paused = true}, MachineState::kReady).accepted);
  pace_.Begun();
  EXPECT_EQ(PaceAfter(1500), 0.0);
}

}  // namespace
}  // namespace contour
