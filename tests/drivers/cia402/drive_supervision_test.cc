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

// A drive that was taken over at its panel or by its maker's program obeys no controlword of ours.
TEST_F(DriveSupervision, AnEnabledDriveThatObeysAnotherIsNoticedAndStopped) {
  for (const bool has_follows_target_bit : {true, false}) {
    MasterConfig config = TwoAxes();
    config.axes[0].drive.follows_target_bit = has_follows_target_bit;
    machine_.emplace(config);
    slave().behaviour.follows = has_follows_target_bit;
    machine().BringUp();
    machine().Reach(DriveGoal::kEnabled);
    machine().Cycles(50);
    EXPECT_FALSE(status().not_following);
    slave().behaviour.remote = false;
    int cycles = 0;
    for (; !status().not_following && cycles < 50; ++cycles) machine().Cycle();
    // Where the bits may mean something else, only disobedience shows.
    EXPECT_EQ(cycles, has_follows_target_bit ? 4 : 50);
    machine().Goal(DriveGoal::kQuickStop);
    int until_stopped = 0;
    for (; !status().stays_enabled && until_stopped < 5000; ++until_stopped) machine().Cycle();
    EXPECT_TRUE(status().stays_enabled) << "it is stopped by NMT";
    EXPECT_FALSE(status(1).not_following);
  }
}

TEST_F(DriveSupervision, ADriveThatNeverShowsBit9IsNotAskedForIt) {
  machine_.emplace();
  slave().behaviour.no_remote_bit = true;
  machine().BringUp();
  machine().Reach(DriveGoal::kEnabled);
  machine().Cycles(50);
  EXPECT_FALSE(status().not_following);
}

TEST_F(DriveSupervision, TheModeOfEachDriveIsReadTenTimesASecondAndNeverOftenerThanReckoned) {
  Enable();
  machine().Cycles(200);
  const std::uint64_t before = slave().reads();
  int last = -10;
  for (int cycle = 0; cycle < 1000; ++cycle) {
    machine().Cycle();
    int requests = 0;
    for (const StampedFrame& f : machine().sent) requests += (f.frame.id & 0x780) == 0x600 ? 1 : 0;
    if (requests == 0) continue;
    EXPECT_EQ(requests, 1);
    EXPECT_GE(cycle - last, 2);
    last = cycle;
  }
  EXPECT_EQ(slave().reads() - before, 10u);
  EXPECT_EQ(slave().last_read(), (FakeSlave::Object{0x6061, 0}));
}

TEST_F(DriveSupervision, AnotherModeThanWasSetIsNoticedAndSetAgainByAReset) {
  Enable();
  machine().Cycles(300);
  EXPECT_FALSE(status().mode_changed);
  slave().objects()[{0x6060, 0}] = slave().objects()[{0x6061, 0}] = 8;
  int cycles = 0;
  for (; !status().mode_changed && cycles < 1000; ++cycles) machine().Cycle();
  EXPECT_LE(cycles, 103);
  EXPECT_FALSE(status(1).mode_changed);
  machine().Goal(DriveGoal::kQuickStop);
  machine().Cycles(5);
  machine().BringUp();
  machine().Cycles(300);
  EXPECT_TRUE(machine().master.operational());
  EXPECT_FALSE(status().mode_changed);
  EXPECT_EQ((slave().objects()[{0x6061, 0}]), 10u);
}

TEST_F(DriveSupervision, ADriveThatAnswersNoSdoWhileItRunsIsNoFault) {
  Enable();
  slave().behaviour.mute_object = FakeSlave::Object{0x6061, 0};
  machine().Cycles(2000);
  EXPECT_FALSE(status().mode_changed);
  EXPECT_TRUE(machine().master.operational());
  slave().behaviour.mute_object.reset();
  slave().objects()[{0x6061, 0}] = 1;
  machine().Cycles(500);
  EXPECT_TRUE(status().mode_changed) << "it is asked again";
}

TEST_F(DriveSupervision, WhatTheDriveRemembersOfErrorsIsReadAfterEach) {
  machine_.emplace();
  slave().objects()[{0x1003, 0}] = 2;
  slave().objects()[{0x1003, 1}] = 0x4210;
  slave().objects()[{0x1003, 2}] = 0x3210;
  machine().BringUp();
  std::vector<FakeSlave::Object> read;
  const auto watch = [&](int cycles) {
    read.clear();
    for (int i = 0; i < cycles; ++i) {
      machine().Cycle();
      for (const StampedFrame& f : machine().sent)
        if (f.frame.id == 0x601 && GetU16(f.frame, 1) == 0x1003) read.push_back({0x1003, f.frame.data[3]});
    }
  };
  const std::vector<FakeSlave::Object> all{{0x1003, 0}, {0x1003, 1}, {0x1003, 2}};
  watch(300);
  EXPECT_EQ(read, all) << "once it is up";
  watch(300);
  EXPECT_TRUE(read.empty());
  slave().Report({0x8120, 0x11});
  watch(300);
  EXPECT_EQ(read, all) << "and after an error";
}

}  // namespace
}  // namespace contour::test
