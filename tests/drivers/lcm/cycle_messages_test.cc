#include "drivers/lcm/cycle_messages.h"

#include <gtest/gtest.h>

#include <contour_lcm/cycle_batch.hpp>
#include <limits>

#include "drivers/lcm/batch_checksums.h"
#include "tests/support/random_cycle_entry.h"
#include "tests/support/same_cycle_entry.h"

namespace contour {
namespace {

TEST(CycleMessagesTest, EveryFieldComesBackBitForBit) {
  test::RandomCycleEntry random(1);
  for (std::uint64_t cycle = 1; cycle <= 200; ++cycle) {
    const CycleEntry entry = random.Next(cycle, cycle % (kMaxAxes + 1));
    contour_lcm::cycle_entry message;
    ToMessage(entry, message);
    contour_lcm::cycle_entry decoded;
    ASSERT_TRUE(Decode(Encode(message), decoded));
    CycleEntry back;
    ASSERT_TRUE(FromMessage(decoded, back));
    test::ExpectSame(entry, back);
    if (HasFailure()) FAIL() << "cycle " << cycle;
  }
}

TEST(CycleMessagesTest, MessagesOnTheirOwnSayWhichCycleAndAxisTheyBelongTo) {
  const CycleEntry entry = test::RandomCycleEntry(2).Next(77, 2);
  contour_lcm::cycle_entry m;
  ToMessage(entry, m);
  EXPECT_EQ(m.contour.cycle, 77);
  EXPECT_EQ(m.timing.cycle, 77);
  EXPECT_EQ(m.axes[1].cycle, 77);
  EXPECT_EQ(m.axes[1].axis, 1);
  EXPECT_EQ(m.estimates[1].axis, 1);
  EXPECT_EQ(m.estimates[1].grid_time_ns, 77'000'000);
}

TEST(CycleMessagesTest, RefusesMoreThanFits) {
  contour_lcm::cycle_entry message;
  ToMessage(CycleEntry{}, message);
  message.input.frames.resize(kMaxFramesPerCycle + 1);
  CycleEntry entry;
  EXPECT_FALSE(FromMessage(message, entry));
}

TEST(CycleMessagesTest, FaultsNameTheReason) {
  CycleRecord record;
  record.cycle = 5;
  record.state = MachineState::kFaulted;
  record.reason = Reason::kEmergencyStop;
  record.axes.resize(2);
  record.axes[1].emergency_code = 0x8130;
  const auto m = FaultsOf(record);
  EXPECT_TRUE(m.faulted);
  EXPECT_EQ(m.reason_name, "emergency_stop");
  ASSERT_EQ(m.axes.size(), 2u);
  EXPECT_EQ(m.axes[1].emergency_code, 0x8130);
}

TEST(CycleMessagesTest, ChecksumKnowsItsPublishedValueAndEveryFlippedBit) {
  EXPECT_EQ(Crc32c("123456789"), 0xE3069283u);
  EXPECT_EQ(Crc32c(std::string(32, '\0')), 0x8A9136AAu);  // RFC 3720, B.4

  contour_lcm::cycle_batch batch;
  batch.crc32c = 0;
  batch.batch_number = 3;
  batch.count = 1;
  batch.entries.resize(1);
  ToMessage(test::RandomCycleEntry(3).Next(1, 1), batch.entries[0]);
  const std::string good = EncodeBatch(batch);
  contour_lcm::cycle_batch back;
  ASSERT_TRUE(DecodeChecked(good, back));
  for (std::size_t i = 0; i < good.size(); i += 7) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x10);
    EXPECT_FALSE(DecodeChecked(bad, back)) << "byte " << i;
  }
  EXPECT_FALSE(DecodeChecked(std::string_view(good).substr(0, 5), back));
}

}  // namespace
}  // namespace contour
