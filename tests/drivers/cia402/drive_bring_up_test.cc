// Finding and configuring the drives, and what stands in its way.
#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "tests/drivers/cia402/two_drives.h"

namespace contour::test {
namespace {

TEST(DriveBringUp, TheDriveHoldsWhatWasConfigured) {
  MasterConfig config = TwoAxes();
  config.axes[0].drive.quick_stop_deceleration_rad_s2 = 1000.0;
  Machine m(config);
  m.BringUp();
  ASSERT_TRUE(m.master.operational());
  auto& o = m.slave[0].objects();
  EXPECT_EQ((o[{0x1016, 1}]), (127u << 16) | 10u);
  EXPECT_EQ((o[{0x1017, 0}]), 50u);
  EXPECT_EQ((o[{0x1006, 0}]), 1000u);
  EXPECT_EQ((o[{0x60C2, 1}]), 1u);
  EXPECT_EQ((o[{0x60C2, 2}]), 0xFDu);  // 10^-3
  EXPECT_EQ((o[{0x6007, 0}]), 3u);
  EXPECT_EQ((o[{0x605A, 0}]), 2u);
  EXPECT_NEAR((o[{0x6085, 0}]), 1000.0 / (2 * std::numbers::pi) * 1048576, 1);
  EXPECT_EQ((o[{0x6072, 0}]), 2355u);  // 1.5 Nm of 0.637 Nm, rounded up
  EXPECT_EQ((o[{0x1400, 5}]), 10u);
  EXPECT_EQ((o[{0x1400, 1}]), 0x201u);
  EXPECT_EQ((o[{0x1400, 2}]), 1u);
  EXPECT_EQ((o[{0x1600, 0}]), 2u);
  EXPECT_EQ((o[{0x1600, 2}]), 0x60710010u);
  EXPECT_EQ((o[{0x1800, 2}]), 1u);
  EXPECT_EQ((o[{0x1A00, 0}]), 3u);
  EXPECT_EQ((o[{0x1A00, 2}]), 0x60640020u);
  EXPECT_EQ((o[{0x1801, 1}]) >> 31, 1u) << "what is not used is switched off";
  EXPECT_EQ((o[{0x6060, 0}]), 10u);
}

TEST(DriveBringUp, PdosAreConfiguredInTheOrderOfCia301) {
  Machine m;
  m.BringUp();
  using Object = FakeSlave::Object;
  std::vector<Object> tpdo;
  for (const Object& o : m.slave[0].writes()) {
    if (o.first == 0x1800 || o.first == 0x1A00) tpdo.push_back(o);
  }
  EXPECT_EQ(tpdo, (std::vector<Object>{{0x1800, 1},
                                       {0x1A00, 0},
                                       {0x1A00, 1},
                                       {0x1A00, 2},
                                       {0x1A00, 3},
                                       {0x1A00, 0},
                                       {0x1800, 2},
                                       {0x1800, 1}}));
}

TEST(DriveBringUp, NothingCyclicIsSentBeforeAllDrivesAreUp) {
  Machine m;
  m.master.StartBringUp();
  int sdos = 0;
  for (int i = 0; i < 5000 && !m.master.operational(); ++i) {
    m.Cycle();
    int sdos_of_cycle = 0;
    for (const StampedFrame& f : m.sent) {
      const bool sdo = f.frame.id > 0x600 && f.frame.id < 0x680;
      const bool nmt = f.frame.id == 0;
      EXPECT_TRUE(sdo || nmt || f.frame.id == 0x77F || m.master.operational()) << std::hex << f.frame.id;
      sdos_of_cycle += sdo ? 1 : 0;
    }
    EXPECT_LE(sdos_of_cycle, 1);
    sdos += sdos_of_cycle;
  }
  EXPECT_GT(sdos, 100);
  EXPECT_EQ(m.master.bring_up().phase, static_cast<std::uint8_t>(BringUpPhase::kOperational));
}

TEST(DriveBringUp, FindsADriveThatSendsNoBootUp) {
  Machine m;
  m.slave[1].behaviour.boot_up = false;
  m.BringUp();
  EXPECT_TRUE(m.master.operational());
}

// A drive may tell of its boot-up twice: it has not heard what came between the two.
TEST(DriveBringUp, ADriveThatBootsAgainBeforeItsFirstAnswerIsAskedAgain) {
  Machine m;
  m.slave[1].behaviour.mute_object = {0x1000, 0};
  m.master.StartBringUp();
  for (int i = 0; i < 5000 && m.master.bring_up().index != 0x1000; ++i) m.Cycle();
  for (int i = 0; i < 5000 && m.master.bring_up().axis != 1; ++i) m.Cycle();
  ASSERT_EQ(m.master.bring_up().index, 0x1000);
  m.Cycles(5);
  m.slave[1].behaviour.mute_object.reset();
  m.Inject(HeartbeatFrame(2, NmtState::kBootUp));
  for (int i = 0; i < 5000 && !m.master.operational() && !m.master.bring_up_failed(); ++i) m.Cycle();
  EXPECT_TRUE(m.master.operational());
}

TEST(DriveBringUp, ADriveThatBootsForEverIsGivenUp) {
  Machine m;
  m.slave[1].behaviour.mute_object = {0x1000, 0};
  m.master.StartBringUp();
  for (int i = 0; i < 5000 && !m.master.operational() && !m.master.bring_up_failed(); ++i) {
    if (m.master.bring_up().axis == 1 && i % 100 == 0) m.Inject(HeartbeatFrame(2, NmtState::kBootUp));
    m.Cycle();
  }
  EXPECT_TRUE(m.master.bring_up_failed());
}

TEST(DriveBringUp, ADriveThatStartsItselfIsNoError) {
  Machine m;
  m.slave[0].behaviour.self_start = true;
  m.BringUp();
  EXPECT_TRUE(m.master.operational());
}

TEST(DriveBringUp, ASilentDriveIsNamedWithHowLongItWaited) {
  Machine m;
  m.slave[1].behaviour.silent = true;
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kNoAnswer);
  const BringUpStatus s = m.master.bring_up();
  EXPECT_EQ(s.axis, 1);
  EXPECT_EQ(s.node_id, 2);
  EXPECT_EQ(s.waited_us, 1'200'000u);  // boot_up_ms and sdo_ms
  EXPECT_EQ(s.index, 0x1000);
  EXPECT_FALSE(m.master.busy());
}

TEST(DriveBringUp, AnObjectThatIsNotAnsweredIsNamed) {
  Machine m;
  m.slave[0].behaviour.mute_object = {0x1A00, 2};
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kSdoTimeout);
  EXPECT_EQ(m.master.bring_up().index, 0x1A00);
  EXPECT_EQ(m.master.bring_up().sub_index, 2);
  EXPECT_EQ(m.master.bring_up().phase, static_cast<std::uint8_t>(BringUpPhase::kPdo));
  EXPECT_EQ(m.master.bring_up().waited_us, 200'000u);
}

TEST(DriveBringUp, AnAbortIsReportedWithItsCode) {
  Machine m;
  m.slave[0].behaviour.aborts[{0x1A00, 2}] = 0x06040041;
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kSdoAbort);
  EXPECT_EQ(m.master.bring_up().abort_code, 0x06040041u);
  EXPECT_EQ(m.master.bring_up().index, 0x1A00);
}

TEST(DriveBringUp, ATransmissionTypeThatDoesNotTakeIsFoundByReadBack) {
  Machine m;
  m.slave[1].behaviour.sticky[{0x1800, 2}] = 254;
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kReadBack);
  const BringUpStatus s = m.master.bring_up();
  EXPECT_EQ(s.axis, 1);
  EXPECT_EQ(s.index, 0x1800);
  EXPECT_EQ(s.sub_index, 2);
  EXPECT_EQ(s.expected, 1u);
  EXPECT_EQ(s.found, 254u);
}

TEST(DriveBringUp, AnotherDriveThanConfiguredIsRefused) {
  Machine m;
  m.slave[0].objects()[{0x1018, 2}] = 0x9999;
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kIdentity);
  EXPECT_EQ(m.master.bring_up().expected, 0x5678u);
  EXPECT_EQ(m.master.bring_up().found, 0x9999u);
}

// Two of one type whose node numbers are exchanged differ in nothing else: x would move for y.
TEST(DriveBringUp, ADriveOfTheSameTypeInItsPlaceIsRefused) {
  MasterConfig config = TwoAxes();
  config.axes[0].drive.identity->serial_number = 71;
  config.axes[1].drive.identity->serial_number = 72;
  for (const bool exchanged : {false, true}) {
    Machine m(config);
    m.slave[0].objects()[{0x1018, 4}] = exchanged ? 72 : 71;
    m.slave[1].objects()[{0x1018, 4}] = exchanged ? 71 : 72;
    m.BringUp();
    EXPECT_EQ(m.error(), exchanged ? BringUpError::kIdentity : BringUpError::kNone);
    if (!exchanged) continue;
    EXPECT_EQ(m.master.bring_up().sub_index, 4);
    EXPECT_EQ(m.master.bring_up().expected, 71u);
    EXPECT_EQ(m.master.bring_up().found, 72u);
  }
}

TEST(DriveBringUp, ADeviceThatIsNoDriveIsRefused) {
  Machine m;
  m.slave[0].objects()[{0x1000, 0}] = 0x000F0191;  // an I/O module
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kNotADrive);
  EXPECT_EQ(m.master.bring_up().found, 401u);
}

TEST(DriveBringUp, RatedTorqueMustAgreeAndMustNotBeZero) {
  Machine zero;
  zero.slave[0].objects()[{0x6076, 0}] = 0;
  zero.BringUp();
  EXPECT_EQ(zero.error(), BringUpError::kRatedTorqueZero);
  Machine other;
  other.slave[0].objects()[{0x6076, 0}] = 1270;
  other.BringUp();
  EXPECT_EQ(other.error(), BringUpError::kRatedTorque);
  EXPECT_EQ(other.master.bring_up().expected, 637u);
  EXPECT_EQ(other.master.bring_up().found, 1270u);
}

TEST(DriveBringUp, ResolutionGearAndPolarityMustAgree) {
  Machine encoder;
  encoder.slave[0].objects()[{0x608F, 1}] = 131072;
  encoder.BringUp();
  EXPECT_EQ(encoder.error(), BringUpError::kUnits);
  EXPECT_EQ(encoder.master.bring_up().found, 131072u);
  Machine per_ten_turns;
  per_ten_turns.slave[0].objects()[{0x608F, 1}] = 10485760;
  per_ten_turns.slave[0].objects()[{0x608F, 2}] = 10;
  per_ten_turns.BringUp();
  EXPECT_TRUE(per_ten_turns.master.operational()) << "the ratio counts";
  Machine gear;
  gear.slave[0].objects()[{0x6091, 1}] = 3;
  gear.BringUp();
  EXPECT_EQ(gear.error(), BringUpError::kUnits);
  Machine inverted;
  inverted.slave[0].objects()[{0x607E, 0}] = 0xC0;
  inverted.BringUp();
  EXPECT_EQ(inverted.error(), BringUpError::kUnits);
  EXPECT_EQ(inverted.master.bring_up().index, 0x607E);
}

TEST(DriveBringUp, ADriveWithoutOptionalObjectsIsTaken) {
  Machine m;
  for (FakeSlave& s : m.slave) {
    for (const int index :
         {0x605A, 0x605B, 0x605C, 0x605D, 0x605E, 0x607E, 0x6502, 0x60E0, 0x60E1, 0x1006, 0x1015}) {
      s.objects().erase({static_cast<std::uint16_t>(index), 0});
    }
    s.objects().erase({0x1400, 5});  // no RPDO timeout: the heartbeat consumer serves
    s.objects().erase({0x1029, 1});
    s.objects().erase({0x60C2, 1});
    s.objects().erase({0x60C2, 2});
    s.objects().erase({0x6091, 1});
    s.objects().erase({0x608F, 1});
    s.behaviour.read_only[{0x6072, 0}] = 0x06010002;
    s.objects()[{0x6072, 0}] = 3000;
  }
  m.BringUp();
  EXPECT_TRUE(m.master.operational()) << std::hex << m.master.bring_up().index;
}

TEST(DriveBringUp, ADriveThatCannotNoticeALostMasterIsRefused) {
  Machine m;
  m.slave[0].objects().erase({0x1016, 1});
  m.BringUp();
  EXPECT_TRUE(m.master.operational()) << "the RPDO timeout serves";
  Machine neither;
  neither.slave[0].objects().erase({0x1016, 1});
  neither.slave[0].objects().erase({0x1400, 5});
  neither.BringUp();
  EXPECT_EQ(neither.error(), BringUpError::kNoLossDetection);
}

TEST(DriveBringUp, ATorqueLimitInTheDriveBelowOursIsRefused) {
  Machine m;
  m.slave[0].behaviour.read_only[{0x6072, 0}] = 0x06010002;
  m.slave[0].objects()[{0x6072, 0}] = 1000;
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kLimitTooLow);
  EXPECT_EQ(m.master.bring_up().expected, 2355u);
}

TEST(DriveBringUp, AModeThatIsNotShownIsReported) {
  Machine m;
  m.slave[0].behaviour.sticky[{0x6060, 0}] = 0;
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kModeNotTaken);
  EXPECT_EQ(m.master.bring_up().expected, 10u);
  EXPECT_GE(m.master.bring_up().waited_us, 500'000u);
  Machine unsupported;
  unsupported.slave[0].objects()[{0x6502, 0}] = 0x80;  // CSP only
  unsupported.BringUp();
  EXPECT_EQ(unsupported.error(), BringUpError::kModeNotSupported);
}

TEST(DriveBringUp, ADriveThatStaysPreOperationalIsReported) {
  Machine m;
  m.slave[1].behaviour.stays_pre_operational = true;
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kNotOperational);
  EXPECT_EQ(m.master.bring_up().axis, 1);
  EXPECT_EQ(m.master.bring_up().found, 0x7Fu);
  EXPECT_EQ(m.master.sync_number(), 0u);
}

TEST(DriveBringUp, ADriveThatRestartsWhileBroughtUpIsReported) {
  Machine m;
  m.master.StartBringUp();
  m.Cycles(60);
  ASSERT_TRUE(m.master.busy());
  m.slave[0].Restart(m.now_ns());
  for (int i = 0; i < 100 && !m.master.bring_up_failed(); ++i) m.Cycle();
  EXPECT_EQ(m.error(), BringUpError::kRestarted);
}

TEST(DriveBringUp, TheBusGoingDownWhileBroughtUpIsReportedAndRecoverable) {
  Machine m;
  m.master.StartBringUp();
  m.Cycles(40);
  m.SetLink(false);
  m.Cycles(2);
  EXPECT_EQ(m.error(), BringUpError::kBusDown);
  m.SetLink(true);
  m.BringUp();
  EXPECT_TRUE(m.master.operational());
}

TEST(DriveBringUp, ADriveThatFailedIsBroughtUpByTheNextAttempt) {
  Machine m;
  m.slave[1].behaviour.silent = true;
  m.BringUp();
  ASSERT_TRUE(m.master.bring_up_failed());
  m.slave[1].behaviour.silent = false;
  m.BringUp();
  EXPECT_TRUE(m.master.operational());
  EXPECT_EQ(m.error(), BringUpError::kNone);
}

TEST(DriveBringUp, BringingUpHealthyDrivesAgainDoesNothing) {
  Machine m;
  m.BringUp();
  m.Cycles(5);
  const auto writes = m.slave[0].writes().size();
  m.master.StartBringUp();
  EXPECT_TRUE(m.master.operational());
  m.Cycles(5);
  EXPECT_EQ(m.slave[0].writes().size(), writes);
}

}  // namespace
}  // namespace contour::test
