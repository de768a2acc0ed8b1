// What a drive says beside its feedback, and what the master makes of it.
#include <gtest/gtest.h>

#include "tests/drivers/cia402/two_drives.h"

namespace contour::test {
namespace {

class DriveSupervision : public ::testing::Test {
 protected:
  void Enable(const MasterConfig& config = TwoAxes()) {
    machine_.emplace(config);
    machine_->BringUp();
    machine_->Reach(DriveGoal::kEnabled);
    machine_->Cycles(10);
  }
  Machine& machine() { return *machine_; }
  const AxisDriveStatus& status(std::size_t axis = 0) { return machine_->master.status()[axis]; }
  FakeSlave& slave() { return machine_->slave[0]; }
  /// The message is on its way, arrives, and acts.
  void Report(std::uint16_t code, std::uint8_t error_register = 1) {
    slave().Report({code, error_register});
    machine_->Cycles(3);
  }

  std::optional<Machine> machine_;
};

TEST_F(DriveSupervision, AnEmergencyStandsUntilTheDriveTakesItBack) {
  Enable();
  Report(0x4210);
  EXPECT_EQ(status().emergency, EmergencyReaction::kStopOnPath);
  EXPECT_EQ(status().emergency_cause, 0x4210);
  EXPECT_EQ(status(1).emergency, EmergencyReaction::kNone);
  Report(0x0000, 0x08);
  EXPECT_EQ(status().emergency, EmergencyReaction::kStopOnPath) << "one error is gone, another is left";
  Report(0x0000, 0x00);
  EXPECT_EQ(status().emergency, EmergencyReaction::kNone);
  EXPECT_EQ(status().emergency_code, 0);
}

TEST_F(DriveSupervision, TheStrongestReactionCounts) {
  Enable();
  Report(0x8110);
  EXPECT_EQ(status().emergency, EmergencyReaction::kWarn);
  Report(0x7305);
  Report(0x8110);
  EXPECT_EQ(status().emergency, EmergencyReaction::kVoltageOff);
  EXPECT_EQ(status().emergency_cause, 0x7305) << "not the last one";
  EXPECT_EQ(status().emergency_code, 0x8110);
}

TEST_F(DriveSupervision, AReactionActsACycleAfterTheMessage) {
  // By then the statusword says whether the drive has stopped by itself.
  Enable();
  slave().Report({0x2310, 1});
  int cycles = 0;
  for (; status().emergency_code == 0 && cycles < 5; ++cycles) machine().Cycle();
  ASSERT_LT(cycles, 5);
  EXPECT_EQ(status().emergency, EmergencyReaction::kNone);
  machine().Cycle();
  EXPECT_EQ(status().emergency, EmergencyReaction::kQuickStop);
}

TEST_F(DriveSupervision, AReactionIsConfiguredStrongerNeverWeaker) {
  MasterConfig config = TwoAxes();
  config.axes[0].drive.emergency_reaction = {{"0x42xx", EmergencyReaction::kQuickStop},
                                             {"0x7305", EmergencyReaction::kWarn}};
  Enable(config);
  Report(0x4210);
  EXPECT_EQ(status().emergency, EmergencyReaction::kQuickStop);
  Report(0x0000, 0);
  Report(0x7305);
  EXPECT_EQ(status().emergency, EmergencyReaction::kVoltageOff);
}

TEST_F(DriveSupervision, ADriveThatLostTheMasterSaysSoAtOnce) {
  Enable();
  slave().Report({0x8130, 0x11});
  for (int i = 0; i < 5 && status().emergency_code == 0; ++i) machine().Cycle();
  EXPECT_TRUE(status().lost_master);
}

TEST_F(DriveSupervision, AResetForgetsWhatWasReported) {
  Enable();
  Report(0x4210);
  Report(0x8130);
  machine().Goal(DriveGoal::kQuickStop);
  machine().Cycles(5);
  machine().master.StartBringUp();
  machine().Cycles(2);
  EXPECT_TRUE(machine().master.operational()) << "the drive is well, nothing is brought up anew";
  EXPECT_EQ(status().emergency, EmergencyReaction::kNone);
  EXPECT_FALSE(status().lost_master);
}

TEST_F(DriveSupervision, AnEnabledDriveThatStopsFollowingIsNoticed) {
  Enable();
  machine().Cycles(50);
  EXPECT_FALSE(status().not_following);
  slave().behaviour.follows = false;
  int cycles = 0;
  for (; !status().not_following && cycles < 50; ++cycles) machine().Cycle();
  // Two SYNCs latch before a set-point can have acted, and the drive may take delay_cycles: so long it may be
  // missing.
  EXPECT_EQ(cycles, 4);
  EXPECT_FALSE(status(1).not_following);
}

TEST_F(DriveSupervision, FollowingIsNotAskedOfADriveThatIsNotEnabled) {
  machine_.emplace();
  machine().slave[0].behaviour.follows = machine().slave[1].behaviour.follows = false;
  machine().BringUp();
  machine().Reach(DriveGoal::kSwitchedOn);
  machine().Cycles(50);
  EXPECT_FALSE(status().not_following);
  machine().Reach(DriveGoal::kEnabled);
  machine().Cycles(10);
  EXPECT_TRUE(status().not_following) << "it never showed the bit";
  machine().Goal(DriveGoal::kQuickStop);
  machine().Cycles(10);
  EXPECT_FALSE(status().not_following);
}

TEST_F(DriveSupervision, ADriveWithoutTheBitIsConfiguredSo) {
  MasterConfig config = TwoAxes();
  config.axes[0].drive.follows_target_bit = false;
  machine_.emplace(config);
  slave().behaviour.follows = false;
  machine().BringUp();
  machine().Reach(DriveGoal::kEnabled);
  machine().Cycles(50);
  EXPECT_FALSE(status().not_following);
}

}  // namespace
}  // namespace contour::test
