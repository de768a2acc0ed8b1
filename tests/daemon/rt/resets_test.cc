#include <gtest/gtest.h>

#include "tests/daemon/rt/transitions_fixture.h"

namespace contour {
namespace {

TEST_F(TransitionsTest, ResetBringsUpAgainAndDoesNotEnable) {
  ToRunning();
  now_.fault = {Reason::kDriveFault, 0};
  Step();
  now_.fault = {};
  EXPECT_TRUE(Step(RequestKind::kReset).start_bring_up);
  for (int i = 0; i < 5; ++i) {
    const Orders orders = Step();
    EXPECT_FALSE(orders.torque_allowed);
    EXPECT_NE(orders.goal, DriveGoal::kEnabled);
  }
  EXPECT_EQ(machine_.state(), MachineState::kIdle);
}

TEST_F(TransitionsTest, AResetWhileIdleTakesTheFaultFromADrive) {
  ToIdle();
  SetDrives(DriveState::kFault);
  now_.request = {RequestKind::kReset, ++sequence_, 0};
  EXPECT_TRUE(machine_.Step(now_).start_bring_up);
  EXPECT_TRUE(machine_.acknowledged_ok());
  now_.request = {};
  EXPECT_EQ(machine_.Step(now_).goal, DriveGoal::kFaultReset);
  SetDrives(DriveState::kSwitchOnDisabled);
  machine_.Step(now_);
  EXPECT_EQ(machine_.state(), MachineState::kIdle);
}

TEST_F(TransitionsTest, AResetWaitsForTheEndOfTheQuickStop) {
  ToRunning();
  now_.io.emergency_stop_ok = false;
  machine_.Step(now_);
  now_.io.emergency_stop_ok = true;
  SetDrives(DriveState::kQuickStopActive);
  now_.request = {RequestKind::kReset, ++sequence_, 0};
  Orders orders = machine_.Step(now_);
  now_.request = {};
  for (int i = 0; i < 5; ++i) {
    EXPECT_FALSE(orders.start_bring_up);
    EXPECT_NE(machine_.acknowledged(), sequence_);
    EXPECT_EQ(orders.goal, DriveGoal::kQuickStop) << "the voltage stays until the ramp has ended";
    orders = machine_.Step(now_);
  }
  SetDrives(DriveState::kSwitchOnDisabled);
  EXPECT_TRUE(machine_.Step(now_).start_bring_up);
  EXPECT_TRUE(machine_.acknowledged_ok());
  EXPECT_EQ(machine_.acknowledged(), sequence_);
  EXPECT_EQ(machine_.state(), MachineState::kStarting);
}

TEST_F(TransitionsTest, AResetDoesNotWaitForeverForADriveOutOfReach) {
  ToRunning();
  now_.lost = {Reason::kBusDown, 0};
  machine_.Step(now_);  // the drives were last seen enabled, and are seen no more
  now_.lost = {};
  now_.request = {RequestKind::kReset, ++sequence_, 0};
  machine_.Step(now_);
  now_.request = {};
  bool begun = false;
  for (int i = 0; i < 25 && !begun; ++i) begun = machine_.Step(now_).start_bring_up;
  EXPECT_TRUE(begun);
}

TEST_F(TransitionsTest, ADriveLostWhileStartingIsAFaultNotAWait) {
  SetDrives(DriveState::kFault);
  Step();
  Step();
  Step(RequestKind::kReset);
  now_.operational = false;  // restarted, with its fault not yet reset
  now_.lost = {Reason::kHeartbeatLost, 1};
  Step();
  EXPECT_EQ(machine_.state(), MachineState::kFaulted);
  EXPECT_EQ(machine_.reason(), Reason::kHeartbeatLost);
  EXPECT_TRUE(Step(RequestKind::kReset).start_bring_up);
}

TEST_F(TransitionsTest, ResetClearsDriveFaultsTheFirstStartDoesNot) {
  SetDrives(DriveState::kFault);
  EXPECT_NE(Step().goal, DriveGoal::kFaultReset);
  EXPECT_NE(Step().goal, DriveGoal::kFaultReset);
  EXPECT_EQ(machine_.state(), MachineState::kFaulted);
  EXPECT_EQ(machine_.reason(), Reason::kDriveFault);
  SetDrives(DriveState::kFault);
  EXPECT_EQ(Step(RequestKind::kReset).goal, DriveGoal::kFaultReset);
  EXPECT_EQ(Step().goal, DriveGoal::kFaultReset);
  EXPECT_EQ(machine_.state(), MachineState::kStarting);
  SetDrives(DriveState::kSwitchOnDisabled);
  Step();
  EXPECT_EQ(machine_.state(), MachineState::kIdle);
}

TEST_F(TransitionsTest, TheTimeForADrivesFaultToGoBeginsWhenItIsFound) {
  ToIdle();
  SetDrives(DriveState::kFault);
  Step(RequestKind::kReset);
  now_.operational = false;
  now_.bring_up_active = true;
  for (int i = 0; i < 1000; ++i) Step();  // listening, booting: far longer than a stop may take
  now_.operational = true;
  now_.bring_up_active = false;
  SetDrives(DriveState::kUnknown);
  for (int i = 0; i < 3; ++i) Step();
  EXPECT_EQ(machine_.state(), MachineState::kStarting) << "no statusword yet";
  SetDrives(DriveState::kFault);
  Step();
  EXPECT_EQ(machine_.state(), MachineState::kStarting) << "its reset is under way";
  SetDrives(DriveState::kSwitchOnDisabled);
  Step();
  EXPECT_EQ(machine_.state(), MachineState::kIdle);
}

TEST_F(TransitionsTest, ADriveThatNeverShowsItsStateIsNotMadeIdle) {
  SetDrives(DriveState::kSwitchedOn);
  now_.drives[1] = DriveState::kUnknown;
  for (int i = 0; i < 100; ++i) Step();
  EXPECT_EQ(machine_.state(), MachineState::kFaulted);
  EXPECT_EQ(machine_.reason(), Reason::kStaleFeedback);
  EXPECT_EQ(machine_.reason_where(), 1);
}

}  // namespace
}  // namespace contour
