// Drives that hold already what they are to hold, and drives that cannot be made to.
#include <gtest/gtest.h>

#include <set>

#include "drivers/cia301/bring_up_text.h"
#include "tests/drivers/cia402/two_drives.h"

namespace contour::test {
namespace {

using Object = FakeSlave::Object;
constexpr std::uint32_t kReadOnlyAbort = 0x06010002;

MasterConfig WithQuickStop() {
  MasterConfig config = TwoAxes();
  for (AxisDriveConfig& a : config.axes) a.drive.quick_stop_deceleration_rad_s2 = 1000.0;
  return config;
}

/// What a drive holds once it has been brought up.
const std::map<Object, std::uint32_t>& Right() {
  static const std::map<Object, std::uint32_t> right = [] {
    Machine m(WithQuickStop());
    m.BringUp();
    EXPECT_TRUE(m.master.operational());
    return m.slave[0].objects();
  }();
  return right;
}

/// Every object that bringing up may write.
std::set<Object> Written() {
  Machine m(WithQuickStop());
  for (auto& [object, value] : m.slave[0].objects())
    if (object.first == 0x605A || object.first == 0x605E || object.first == 0x1029)
      value = 7;  // right by chance in this slave
  m.BringUp();
  return {m.slave[0].writes().begin(), m.slave[0].writes().end()};
}

std::string Text(const Machine& m) {
  return BringUpText(m.master.bring_up(), std::array<std::string, 2>{"x", "y"});
}

TEST(RightAlready, WhatIsRightIsNotWritten) {
  Machine m(WithQuickStop());
  m.slave[0].objects() = Right();
  m.BringUp();
  ASSERT_TRUE(m.master.operational()) << Text(m);
  // A reset of the communication takes the heartbeats from it.
  EXPECT_EQ(m.slave[0].writes(), (std::vector<Object>{{0x1016, 1}, {0x1017, 0}}));
}

TEST(RightAlready, ReadOnlyAndEqualIsRight) {
  Machine m(WithQuickStop());
  m.slave[0].objects() = Right();
  for (const Object& o : Written()) m.slave[0].behaviour.read_only[o] = kReadOnlyAbort;
  m.BringUp();
  EXPECT_TRUE(m.master.operational()) << Text(m);
  EXPECT_TRUE(m.slave[0].writes().empty());
}

TEST(RightAlready, ReadOnlyAndDifferentIsNamedWithBothValuesAndWhatToDo) {
  struct Case {
    Object object;
    std::uint32_t found;
    const char* key;
  };
  for (const Case& c :
       {Case{{0x6007, 0}, 1, "drive.abort_connection_option"},
        Case{{0x605A, 0}, 6, "drive.quick_stop_option"}, Case{{0x605E, 0}, 0, "0x605E"},
        Case{{0x6085, 0}, 12345, "drive.quick_stop_deceleration_rad_s2"},
        Case{{0x60C2, 1}, 2, "machine.cycle_us"}, Case{{0x60C2, 2}, 0xFC, "machine.cycle_us"},
        Case{{0x1006, 0}, 2000, "machine.cycle_us"}, Case{{0x1017, 0}, 1000, "drive.heartbeat_ms"},
        Case{{0x1A00, 2}, 0x606C0020, "PDO is fixed"}, Case{{0x1600, 0}, 1, "PDO is fixed"},
        Case{{0x1400, 2}, 255, "PDO is fixed"}}) {
    Machine m(WithQuickStop());
    m.slave[0].objects() = Right();
    for (const Object& o : Written()) m.slave[0].behaviour.read_only[o] = kReadOnlyAbort;
    m.slave[0].objects()[c.object] = c.found;
    m.BringUp();
    EXPECT_EQ(m.error(), BringUpError::kReadOnlyDiffers) << std::hex << c.object.first;
    EXPECT_EQ(m.master.bring_up().index, c.object.first);
    EXPECT_EQ(m.master.bring_up().sub_index, c.object.second);
    EXPECT_EQ(m.master.bring_up().found, c.found);
    EXPECT_EQ(m.master.bring_up().expected, Right().at(c.object));
    EXPECT_NE(Text(m).find(c.key), std::string::npos) << Text(m);
  }
}

// How far an axis goes whose drive faults is promised by the ramp; of what the others of these objects say,
// no bound is made.
TEST(RightAlready, AFaultReactionThatDoesNotTakeIsNamed) {
  Machine m(WithQuickStop());
  m.slave[0].objects()[{0x605E, 0}] = 1;
  m.slave[0].behaviour.sticky[{0x605E, 0}] = 0;
  m.BringUp();
  EXPECT_TRUE(m.master.bring_up_failed());
  EXPECT_EQ(m.master.bring_up().index, 0x605E);
  EXPECT_EQ(m.master.bring_up().expected, 2u);
  EXPECT_EQ(m.master.bring_up().found, 0u);

  Machine others(WithQuickStop());
  for (const Object& o :
       {Object{0x605B, 0}, Object{0x605C, 0}, Object{0x605D, 0}, Object{0x1015, 0}, Object{0x1029, 1}}) {
    others.slave[0].objects()[o] = 4;
    others.slave[0].behaviour.read_only[o] = kReadOnlyAbort;
  }
  others.BringUp();
  EXPECT_TRUE(others.master.operational()) << Text(others);
}

TEST(RightAlready, AReadOnlySyncPeriodOfZeroWatchesNothingAndIsRight) {
  Machine m(WithQuickStop());
  m.slave[0].behaviour.read_only[{0x1006, 0}] = kReadOnlyAbort;
  m.BringUp();
  EXPECT_TRUE(m.master.operational()) << Text(m);
}

TEST(RightAlready, AReadOnlyConsumerOfAnotherHeartbeatNeedsTheOtherWatchdog) {
  const std::uint32_t other = (126u << 16) | 500u;
  Machine m;
  m.slave[0].objects()[{0x1016, 1}] = other;
  m.slave[0].behaviour.read_only[{0x1016, 1}] = kReadOnlyAbort;
  m.BringUp();
  EXPECT_TRUE(m.master.operational()) << "the RPDO timeout serves: " << Text(m);
  Machine alone;
  alone.slave[0].objects()[{0x1016, 1}] = other;
  alone.slave[0].behaviour.read_only[{0x1016, 1}] = kReadOnlyAbort;
  alone.slave[0].objects().erase({0x1400, 5});
  alone.BringUp();
  EXPECT_EQ(alone.error(), BringUpError::kNoLossDetection);
  EXPECT_EQ(alone.master.bring_up().found, other);
  EXPECT_EQ(alone.master.bring_up().expected, (127u << 16) | 10u);
}

TEST(RightAlready, AFixedMappingIsLeftAloneWhereOnlyTheTransmissionTypeDiffers) {
  Machine m(WithQuickStop());
  m.slave[0].objects() = Right();
  for (std::uint8_t sub = 0; sub <= 8; ++sub)
    m.slave[0].behaviour.read_only[{0x1A00, sub}] = m.slave[0].behaviour.read_only[{0x1600, sub}] =
        kReadOnlyAbort;
  m.slave[0].objects()[{0x1800, 2}] = 254;
  m.BringUp();
  EXPECT_TRUE(m.master.operational()) << Text(m);
  EXPECT_EQ((m.slave[0].objects()[{0x1800, 2}]), 1u);
}

TEST(RightAlready, ADriveThatOnlyShowsWhatCanBeWrittenIsWritten) {
  // An object that cannot be read is written as ever; this slave then refuses it, which is what is reported.
  Machine m;
  m.slave[0].behaviour.aborts[{0x6007, 0}] = 0x06010001;  // write-only
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kSdoAbort);
  EXPECT_EQ(m.master.bring_up().index, 0x6007);
}

TEST(RightAlready, ASegmentedReplyIsNamedAndTheTransferBrokenOff) {
  Machine m;
  m.slave[0].behaviour.segmented = Object{0x6076, 0};
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kSegmentedReply);
  EXPECT_EQ(m.master.bring_up().index, 0x6076);
  EXPECT_EQ(m.master.bring_up().found, 12u);
  EXPECT_EQ(Text(m).find("refused"), std::string::npos) << Text(m);
  m.Cycles(3);
  ASSERT_EQ(m.slave[0].master_aborts().size(), 1u);
  EXPECT_EQ(m.slave[0].master_aborts()[0].first, (Object{0x6076, 0}));
  EXPECT_EQ(m.slave[0].master_aborts()[0].second, 0x06070012u);
}

TEST(RightAlready, ABootThatTakesLongerThanItsDeadlineNamesTheKey) {
  Machine m;
  m.slave[0].behaviour.boot_ns = 2'500'000'000;
  m.BringUp();
  EXPECT_EQ(m.error(), BringUpError::kNoAnswer);
  EXPECT_NE(
      Text(m).find("no boot-up message within 1000 ms (drive.boot_up_ms) and no reply to SDO within 200 ms "
                   "(drive.sdo_ms)"),
      std::string::npos)
      << Text(m);
  MasterConfig patient = TwoAxes();
  for (AxisDriveConfig& a : patient.axes) a.drive.boot_up_ms = 3000;
  Machine waits(patient);
  waits.slave[0].behaviour.boot_ns = 2'500'000'000;
  waits.BringUp();
  EXPECT_TRUE(waits.master.operational()) << Text(waits);
}

TEST(RightAlready, ADriveThatBootsWhileItIsAskedIsAskedAgain) {
  Machine m;
  m.slave[0].behaviour.boot_ns = 1'100'000'000;
  m.BringUp();
  EXPECT_TRUE(m.master.operational()) << Text(m);
}

TEST(RightAlready, LogsOfFormat4ReplayWithTheScriptOfTheirTime) {
  MasterConfig config = TwoAxes();
  config.start_up = StartUp::kOfLogFormat4;
  Machine m(config);
  m.slave[0].objects() = Right();
  m.BringUp();
  ASSERT_TRUE(m.master.operational()) << Text(m);
  EXPECT_GT(m.slave[0].writes().size(), 30u) << "all of it is written";
  const std::uint64_t reads = m.slave[0].reads();
  m.Cycles(1000);
  EXPECT_EQ(m.slave[0].reads(), reads) << "nothing is asked while it runs";
}

}  // namespace
}  // namespace contour::test
