#include "daemon/telemetry/emergency_history.h"

#include <gtest/gtest.h>

#include "drivers/cia301/sdo_transfer.h"

namespace contour {
namespace {

class EmergencyHistoryTest : public ::testing::Test {
 protected:
  EmergencyHistoryTest() { history_.Watch({{0, 0x181}, {1, 0x181}}); }
  void Receive(const CanFrame& frame, std::uint8_t bus = 0) {
    CycleEntry entry;
    entry.input.cycle = ++cycle_;
    entry.input.frames.push_back({frame, bus, 0});
    history_.Add(entry);
  }
  static CanFrame Reply(std::uint16_t index, std::uint8_t sub, std::uint32_t value) {
    CanFrame f = SdoReadFrame(1, index, sub);
    f.id = 0x581;
    f.data[0] = 0x43;
    PutU32(f, 4, value);
    return f;
  }
  EmergencyHistory history_{2};
  std::uint64_t cycle_ = 0;
};

TEST_F(EmergencyHistoryTest, KeepsWhatEachDriveSaidWithItsCycle) {
  CanFrame message = EmergencyFrame(1, {0x4210, 0x09});
  message.data[3] = 0xAB;
  Receive(message);
  ASSERT_EQ(history_.news().size(), 1u);
  EXPECT_EQ(EmergencyLine(history_.news()[0], "x"),
            "x: emergency 0x4210 (excess temperature of the device), error register 0x09, in cycle 1");
  Receive(EmergencyFrame(1, {0x3210, 0x05}), 1);
  Receive(SyncFrame());
  EXPECT_TRUE(history_.news().empty());
  ASSERT_EQ(history_.drives()[0].received.size(), 1u);
  EXPECT_EQ(history_.drives()[0].received[0].maker[0], 0xAB);
  ASSERT_EQ(history_.drives()[1].received.size(), 1u) << "the same node on another bus";
  EXPECT_EQ(history_.drives()[1].received[0].cycle, 2u);
}

TEST_F(EmergencyHistoryTest, KeepsTheNewestAndCountsAll) {
  for (unsigned i = 0; i < 20; ++i) Receive(EmergencyFrame(1, {static_cast<std::uint16_t>(0x1000 + i), 1}));
  EXPECT_EQ(history_.drives()[0].received_count, 20u);
  ASSERT_EQ(history_.drives()[0].received.size(), kKeptEmergencies);
  EXPECT_EQ(history_.drives()[0].received.back().emergency.error_code, 0x1013);
}

TEST_F(EmergencyHistoryTest, TakesWhatTheDriveRemembersFromTheAnswers) {
  Receive(Reply(0x1003, 0, 2));
  Receive(Reply(0x1003, 1, 0x00074210));
  Receive(Reply(0x6061, 0, 10));
  Receive(Reply(0x1003, 2, 0x3210));
  EXPECT_EQ(history_.drives()[0].stored, (std::vector<std::uint32_t>{0x00074210, 0x3210}));
  EXPECT_EQ(history_.drives()[0].stored_cycle, 4u);
  EXPECT_EQ(history_.drives()[0].mode_answers, 1u);
  Receive(Reply(0x1003, 0, 0));
  EXPECT_TRUE(history_.drives()[0].stored.empty()) << "read anew";
}

TEST_F(EmergencyHistoryTest, CountsHowOftenTheModeWasAskedFor) {
  CycleEntry entry;
  entry.input.cycle = ++cycle_;
  entry.output.frames.push_back({SdoReadFrame(1, 0x6061, 0), 1, 0});
  history_.Add(entry);
  EXPECT_EQ(history_.drives()[1].mode_reads, 1u);
  EXPECT_EQ(history_.drives()[1].mode_answers, 0u);
}

}  // namespace
}  // namespace contour
