#include "drivers/cia402/drive_state.h"

#include <gtest/gtest.h>

#include "drivers/cia402/drive_walk.h"

namespace contour {
namespace {

using enum DriveState;

TEST(Statusword, DecodesTheTableOfCia402) {
  EXPECT_EQ(DecodeStatusword(0x0000), kNotReadyToSwitchOn);
  EXPECT_EQ(DecodeStatusword(0x0240), kSwitchOnDisabled);
  EXPECT_EQ(DecodeStatusword(0x0260), kSwitchOnDisabled) << "the quick-stop bit does not matter here";
  EXPECT_EQ(DecodeStatusword(0x0231), kReadyToSwitchOn);
  EXPECT_EQ(DecodeStatusword(0x0233), kSwitchedOn);
  EXPECT_EQ(DecodeStatusword(0x1637), kOperationEnabled);
  EXPECT_EQ(DecodeStatusword(0x0217), kQuickStopActive);
  EXPECT_EQ(DecodeStatusword(0x021F), kFaultReactionActive);
  EXPECT_EQ(DecodeStatusword(0x0218), kFault);
  EXPECT_EQ(DecodeStatusword(0x0022), kUnknown);
  for (const int others : {0, statusword::kRemote + 0, statusword::kFollowsTarget + 0})
    EXPECT_EQ(DecodeStatusword(static_cast<std::uint16_t>(0x0037 | others)), kOperationEnabled) << others;
}

/// A drive that obeys at once, for walking.
DriveState Obey(DriveState s, std::uint16_t word) {
  if (s == kFault || s == kFaultReactionActive || s == kNotReadyToSwitchOn) return s;
  if ((word & 2) == 0) return kSwitchOnDisabled;
  if ((word & 4) == 0) return s == kOperationEnabled ? kQuickStopActive : kSwitchOnDisabled;
  switch (word & 0x0F) {
    case 0x06:
      return s == kQuickStopActive ? s : kReadyToSwitchOn;
    case 0x07:
      return s == kReadyToSwitchOn || s == kOperationEnabled ? kSwitchedOn : s;
    default:
      return s == kSwitchedOn ? kOperationEnabled : s;
  }
}

TEST(Controlword, ReachesEveryGoalFromEveryStateInAFewSteps) {
  for (const DriveGoal goal : {DriveGoal::kDisabled, DriveGoal::kSwitchedOn, DriveGoal::kEnabled}) {
    for (const DriveState start :
         {kSwitchOnDisabled, kReadyToSwitchOn, kSwitchedOn, kOperationEnabled, kQuickStopActive}) {
      DriveState s = start;
      int steps = 0;
      while (!IsAt(s, goal) && steps < 5) {
        s = Obey(s, Controlword(s, goal));
        ++steps;
      }
      EXPECT_TRUE(IsAt(s, goal)) << Name(start);
      EXPECT_LE(steps, 4);
      EXPECT_EQ(Obey(s, Controlword(s, goal)), s) << "and stays there";
    }
  }
}

TEST(Controlword, NeverEnablesWithoutBeingAsked) {
  for (const DriveGoal goal :
       {DriveGoal::kDisabled, DriveGoal::kSwitchedOn, DriveGoal::kQuickStop, DriveGoal::kFaultReset}) {
    for (int s = 0; s <= 8; ++s) {
      EXPECT_NE(Controlword(static_cast<DriveState>(s), goal) & 0x0F, 0x0F);
    }
  }
}

TEST(Controlword, QuickStopIsTheSameInEveryState) {
  for (int s = 0; s <= 8; ++s)
    EXPECT_EQ(Controlword(static_cast<DriveState>(s), DriveGoal::kQuickStop), 0x02);
}

TEST(DriveWalk, SaysWhereADriveStayed) {
  DriveWalk walk(10, 20);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(walk.Step(kReadyToSwitchOn, DriveGoal::kEnabled, 1), 0x07);
    EXPECT_FALSE(walk.late());
  }
  walk.Step(kReadyToSwitchOn, DriveGoal::kEnabled, 1);
  EXPECT_TRUE(walk.late());
  EXPECT_EQ(walk.stuck_in(), kReadyToSwitchOn);
  walk.Step(kSwitchedOn, DriveGoal::kEnabled, 1);
  EXPECT_FALSE(walk.late()) << "it moves again";
}

TEST(DriveWalk, ADriveThatLeavesEnabledIsNotEnabledAgain) {
  DriveWalk walk(10, 20);
  walk.Step(kSwitchedOn, DriveGoal::kEnabled, 1);
  EXPECT_EQ(walk.Step(kOperationEnabled, DriveGoal::kEnabled, 1), 0x0F);
  EXPECT_FALSE(walk.left_enabled());
  EXPECT_EQ(walk.Step(kSwitchedOn, DriveGoal::kEnabled, 1), 0x02);
  EXPECT_TRUE(walk.left_enabled());
  EXPECT_EQ(walk.Step(kSwitchOnDisabled, DriveGoal::kEnabled, 1), 0x02);
  walk.Step(kSwitchOnDisabled, DriveGoal::kSwitchedOn, 1);
  EXPECT_FALSE(walk.left_enabled()) << "a new goal begins afresh";
  EXPECT_EQ(walk.Step(kSwitchOnDisabled, DriveGoal::kEnabled, 1), 0x06);
}

TEST(DriveWalk, FaultResetIsARisingEdgeThatRepeats) {
  DriveWalk walk(500, 1000);
  int edges = 0;
  bool high = false;
  for (int i = 0; i < 60; ++i) {
    const std::uint16_t word = walk.Step(kFault, DriveGoal::kFaultReset, 1);
    EXPECT_EQ(word & ~0x80, 0);
    if ((word & 0x80) != 0 && !high) ++edges;
    high = (word & 0x80) != 0;
    EXPECT_FALSE(i == 0 && high) << "low first, whatever went before";
  }
  EXPECT_EQ(edges, 3);
  EXPECT_EQ(walk.Step(kSwitchOnDisabled, DriveGoal::kFaultReset, 1), 0x00);
  EXPECT_TRUE(walk.at_goal());
}

TEST(DriveWalk, AQuickStopThatDoesNotEndDisablesTheVoltage) {
  DriveWalk walk(10, 20);
  EXPECT_EQ(walk.Step(kOperationEnabled, DriveGoal::kQuickStop, 1), 0x02);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(walk.Step(kQuickStopActive, DriveGoal::kQuickStop, 1), 0x02);
  EXPECT_EQ(walk.Step(kQuickStopActive, DriveGoal::kQuickStop, 1), 0x00);
  EXPECT_TRUE(walk.late());
}

}  // namespace
}  // namespace contour
