#pragma once

#include <gtest/gtest.h>

#include "daemon/rt/transitions.h"

namespace contour {

/// Drives the state machine with drives that obey at once.
class TransitionsTest : public ::testing::Test {
 protected:
  TransitionsTest() : machine_({10, 20, 30}) {
    now_.operational = true;
    now_.drives.resize(2);
    SetDrives(DriveState::kSwitchedOn);
    now_.io = {true, true, true, true, 20.0};
    now_.path_at_rest = true;
  }

  void SetDrives(DriveState s) {
    for (DriveState& d : now_.drives) d = s;
  }
  Orders Step(RequestKind kind = RequestKind::kNone, std::uint32_t program = 0) {
    now_.request = {kind, kind == RequestKind::kNone ? 0 : ++sequence_, program};
    const Orders orders = machine_.Step(now_);
    if (orders.goal == DriveGoal::kEnabled) SetDrives(DriveState::kOperationEnabled);
    if (orders.goal == DriveGoal::kQuickStop) SetDrives(DriveState::kSwitchOnDisabled);
    if (orders.goal == DriveGoal::kSwitchedOn) SetDrives(DriveState::kSwitchedOn);
    return orders;
  }
  void ToIdle() {
    Step();
    Step();
    ASSERT_EQ(machine_.state(), MachineState::kIdle);
  }
  void ToReady() {
    ToIdle();
    Step(RequestKind::kEnable);
    for (int i = 0; i < 5; ++i) Step();
    ASSERT_EQ(machine_.state(), MachineState::kReady);
  }
  void ToRunning() {
    ToReady();
    EXPECT_TRUE(Step(RequestKind::kRun, 3).expect_path);
    now_.path_prefetched = now_.path_begins_here = true;
    now_.path_at_rest = false;
    EXPECT_TRUE(Step().start_path);
    ASSERT_EQ(machine_.state(), MachineState::kRunning);
  }

  Situation now_;
  Transitions machine_;
  std::uint32_t sequence_ = 0;
};

}  // namespace contour
