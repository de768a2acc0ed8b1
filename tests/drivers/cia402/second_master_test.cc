// Another master on the bus: before the first frame, while the drives are brought up, and later.
#include <gtest/gtest.h>

#include <vector>

#include "drivers/cia301/bring_up_text.h"
#include "tests/drivers/cia402/two_drives.h"

namespace contour::test {
namespace {

constexpr int kListen_cycles = 300;

MasterConfig Listening() {
  MasterConfig config = TwoAxes();
  config.buses[0].listen_ms = kListen_cycles;
  return config;
}

struct Sign {
  const char* what;
  CanFrame frame;
};

CanFrame Frame(std::uint16_t id, std::uint8_t length) { return {id, length, {}}; }

std::vector<Sign> SignsOfAMaster() {
  return {{"SYNC", SyncFrame()},
          {"SYNC with counter", Frame(0x080, 1)},
          {"NMT to all", NmtFrame(NmtCommand::kStart, 0)},
          {"heartbeat with our master's number", HeartbeatFrame(127, NmtState::kOperational)},
          {"set-point", Frame(0x201, 4)},
          {"set-point in RPDO4", Frame(0x502, 8)}};
}

/// What drives send, and other devices.
std::vector<Sign> NoSigns() {
  return {{"heartbeat of a drive", HeartbeatFrame(1, NmtState::kOperational)},
          {"boot-up", HeartbeatFrame(2, NmtState::kBootUp)},
          {"heartbeat of another device", HeartbeatFrame(5, NmtState::kOperational)},
          {"TPDO1", Frame(0x181, 8)},
          {"TPDO4", Frame(0x482, 8)},
          {"emergency", EmergencyFrame(1, {0x3210, 1})},
          {"SDO reply", Frame(0x581, 8)},
          {"set-point of another device", Frame(0x205, 4)},
          {"SDO request to another device", Frame(0x605, 8)},
          {"time stamp", Frame(0x100, 6)}};
}

TEST(SecondMaster, NothingIsSentWhileListening) {
  Machine m(Listening());
  m.master.StartBringUp();
  for (int i = 1; i < kListen_cycles; ++i) {
    m.Cycle();
    ASSERT_TRUE(m.sent.empty()) << "in cycle " << i;
    ASSERT_EQ(m.master.bring_up().phase, static_cast<std::uint8_t>(BringUpPhase::kListen));
  }
  m.Cycle();
  EXPECT_FALSE(m.sent.empty());
  for (int i = 0; i < 2000 && !m.master.operational(); ++i) m.Cycle();
  EXPECT_TRUE(m.master.operational());
}

TEST(SecondMaster, AnyFrameOfAMasterRefusesTheStart) {
  std::vector<Sign> signs = SignsOfAMaster();
  signs.push_back({"SDO request", SdoReadFrame(2, 0x6064, 0)});
  for (const Sign& sign : signs) {
    Machine m(Listening());
    m.master.StartBringUp();
    m.Cycles(kListen_cycles - 10);
    m.Inject(sign.frame);
    for (int i = 0; i < 500; ++i) {
      m.Cycle();
      ASSERT_TRUE(m.sent.empty()) << sign.what;
    }
    EXPECT_EQ(m.error(), BringUpError::kSecondMaster) << sign.what;
    EXPECT_EQ(m.master.bring_up().found, sign.frame.id) << sign.what;
    EXPECT_EQ(m.master.second_master(), 0) << sign.what;
  }
}

TEST(SecondMaster, WhatDrivesAndOtherDevicesSendIsNoMaster) {
  Machine m(Listening());
  m.master.StartBringUp();
  for (int i = 0; i < 20; ++i) {
    for (const Sign& other : NoSigns()) {
      m.Inject(other.frame);
      m.Cycle();
      ASSERT_EQ(m.error(), BringUpError::kNone) << other.what;
    }
  }
}

TEST(SecondMaster, SeenWhileTheDrivesAreConfiguredItEndsTheStart) {
  for (const Sign& sign : SignsOfAMaster()) {
    Machine m(Listening());
    m.master.StartBringUp();
    m.Cycles(kListen_cycles + 40);
    ASSERT_TRUE(m.master.BringingUp());
    m.Inject(sign.frame);
    m.Cycles(3);
    EXPECT_EQ(m.error(), BringUpError::kSecondMaster) << sign.what;
    for (int i = 0; i < 100; ++i) {
      m.Cycle();
      ASSERT_TRUE(m.sent.empty()) << sign.what;
    }
  }
}

TEST(SecondMaster, SeenInOperationItIsNamedAndTheDrivesStayInHand) {
  for (const Sign& sign : SignsOfAMaster()) {
    Machine m(Listening());
    m.BringUp();
    m.Reach(DriveGoal::kEnabled);
    m.Inject(sign.frame);
    m.Cycles(2);
    EXPECT_EQ(m.master.second_master(), 0) << sign.what;
    EXPECT_EQ(m.error(), BringUpError::kSecondMaster) << sign.what;
    EXPECT_TRUE(m.SentSync()) << "until told to fall silent the drives can be stopped";
    m.master.FallSilent();
    for (int i = 0; i < 100; ++i) {
      m.Cycle();
      ASSERT_TRUE(m.sent.empty()) << sign.what;
    }
  }
}

TEST(SecondMaster, ADriveThatObeysTheOtherOneIsStoppedByNmt) {
  Machine m(Listening());
  m.BringUp();
  m.Reach(DriveGoal::kEnabled);
  m.slave[0].behaviour.obeys_another = true;
  m.Inject(NmtFrame(NmtCommand::kStart, 0));
  m.Cycles(2);
  ASSERT_NE(m.master.second_master(), DriveMaster::kNoBus);
  EXPECT_EQ(m.slave[0].nmt(), NmtState::kOperational) << "still enabled, as it shall be";
  m.Goal(DriveGoal::kQuickStop);
  m.Cycles(8);
  EXPECT_EQ(m.slave[0].nmt(), NmtState::kStopped);
  EXPECT_EQ(m.slave[1].nmt(), NmtState::kOperational) << "it obeys";
  EXPECT_EQ(m.slave[1].state(), DriveState::kSwitchOnDisabled);

  m.Inject(NmtFrame(NmtCommand::kStart, 0));
  m.Cycles(8);
  EXPECT_EQ(m.slave[0].nmt(), NmtState::kStopped) << "as often as the other one starts it";

  m.slave[0].behaviour.obeys_another = false;
  m.master.FallSilent();
  m.Cycles(kListen_cycles + 10);
  m.BringUp();
  EXPECT_TRUE(m.master.operational()) << "a bring-up wakes it";
}

TEST(SecondMaster, NoOtherDriveThatDoesNotObeyIsStoppedByNmt) {
  Machine m(Listening());
  m.BringUp();
  m.Reach(DriveGoal::kEnabled);
  m.slave[0].behaviour.obeys_another = true;  // slow to act, for all we know
  m.Goal(DriveGoal::kQuickStop);
  m.Cycles(50);
  EXPECT_EQ(m.slave[0].nmt(), NmtState::kOperational);
}

TEST(SecondMaster, ADriveThatIgnoresItsControlwordIsNamedAndStoppedByNmtInTheEnd) {
  Machine m(Listening());
  m.BringUp();
  m.Reach(DriveGoal::kEnabled);
  m.slave[0].behaviour.obeys_another = true;
  m.Goal(DriveGoal::kSwitchedOn);
  const int within = static_cast<int>(Listening().axes[0].drive.quick_stop_ms);
  for (int i = 0; i < within; ++i) {
    m.Cycle();
    ASSERT_FALSE(m.master.status()[0].stays_enabled) << i;
  }
  bool named = false;
  for (int i = 0; i < 10 && m.slave[0].nmt() == NmtState::kOperational; ++i) {
    m.Cycle();
    named = named || m.master.status()[0].stays_enabled;
    EXPECT_FALSE(m.master.status()[1].stays_enabled);
  }
  EXPECT_TRUE(named) << "before it is stopped";
  EXPECT_EQ(m.slave[0].nmt(), NmtState::kStopped);
  EXPECT_EQ(m.slave[1].nmt(), NmtState::kOperational);
}

TEST(SecondMaster, ADriveThatIsFoundEnabledHasItsTimeToLeaveThat) {
  Machine m(Listening());
  m.BringUp();
  m.Goal(DriveGoal::kDisabled);
  m.Cycles(3000);
  m.slave[0].EnterPreOperational();
  m.Cycles(100);
  m.BringUp();
  m.Reach(DriveGoal::kEnabled);
  m.slave[0].behaviour.obeys_another = true;
  m.Goal(DriveGoal::kDisabled);
  m.Cycles(100);
  EXPECT_FALSE(m.master.status()[0].stays_enabled);
}

TEST(SecondMaster, AServiceToolBesideUsIsNone) {
  Machine m(Listening());
  m.BringUp();
  for (int i = 0; i < 100; ++i) {
    m.Inject(SdoReadFrame(1, 0x6064, 0));
    m.Cycle();
  }
  EXPECT_TRUE(m.master.operational());
  EXPECT_EQ(m.master.second_master(), DriveMaster::kNoBus);
}

TEST(SecondMaster, AfterItIsGoneTheNextStartListensForTheRestOfTheTime) {
  Machine m(Listening());
  m.BringUp();
  m.Inject(SyncFrame());
  m.Cycles(2);
  m.master.FallSilent();
  m.Cycles(kListen_cycles / 2);
  m.master.StartBringUp();
  int silent = 0;
  for (m.Cycle(); m.sent.empty() && silent < 1000; m.Cycle()) ++silent;
  EXPECT_NEAR(silent, kListen_cycles / 2, 5);
  for (int i = 0; i < 2000 && !m.master.operational(); ++i) m.Cycle();
  EXPECT_TRUE(m.master.operational());
}

TEST(SecondMaster, ABusThatWasHeardLongEnoughIsNotListenedToAgain) {
  Machine m(Listening());
  m.BringUp();
  m.Cycles(kListen_cycles);
  m.slave[0].Restart(m.now_ns());
  m.Cycles(5);
  m.master.StartBringUp();
  m.Cycle();
  EXPECT_FALSE(m.sent.empty());
}

TEST(SecondMaster, AfterTheLinkWasDownItListensAnew) {
  Machine m(Listening());
  m.BringUp();
  m.SetLink(false);
  m.Cycles(10);
  m.SetLink(true);
  m.master.StartBringUp();
  for (int i = 1; i < kListen_cycles - 5; ++i) {
    m.Cycle();
    ASSERT_TRUE(m.sent.empty()) << "in cycle " << i;
  }
}

TEST(SecondMaster, ATransferThatCollidesWithAServiceToolsIsBegunAnew) {
  Machine m;
  // The drive answers the tool and drops our request.
  m.slave[0].behaviour.mute_object = {0x1A00, 2};
  m.master.StartBringUp();
  const auto at_object = [&] {
    return m.master.bring_up().index == 0x1A00 && m.master.bring_up().sub_index == 2;
  };
  for (int i = 0; i < 2000 && !at_object(); ++i) m.Cycle();
  ASSERT_TRUE(at_object());
  m.Inject(SdoReadFrame(1, 0x6064, 0));
  m.Cycles(3);
  m.slave[0].behaviour.mute_object.reset();
  for (int i = 0; i < 2000 && !m.master.operational() && !m.master.bring_up_failed(); ++i) m.Cycle();
  EXPECT_TRUE(m.master.operational());
}

TEST(SecondMaster, TransfersAreNotRetriedForEver) {
  Machine m;
  m.slave[0].behaviour.mute_object = {0x1A00, 2};
  m.master.StartBringUp();
  for (int i = 0; i < 5000 && !m.master.bring_up_failed(); ++i) {
    m.Inject(SdoReadFrame(1, 0x6064, 0));
    m.Cycle();
  }
  EXPECT_EQ(m.error(), BringUpError::kSdoTimeout);
}

TEST(SecondMaster, TheTextSaysWhatWasSeen) {
  BringUpStatus s;
  s.error = static_cast<std::uint8_t>(BringUpError::kSecondMaster);
  const auto text = [&](std::uint32_t id) {
    s.found = id;
    return SecondMasterText(s);
  };
  EXPECT_EQ(text(0x080), "SYNC (COB-ID 0x080)");
  EXPECT_EQ(text(0x000), "NMT command (COB-ID 0x000)");
  EXPECT_EQ(text(0x77F), "heartbeat under our master's node number (COB-ID 0x77F)");
  EXPECT_EQ(text(0x201), "set-points to node 1 (COB-ID 0x201)");
  EXPECT_EQ(text(0x602), "SDO request to node 2 (COB-ID 0x602)");
}

}  // namespace
}  // namespace contour::test
