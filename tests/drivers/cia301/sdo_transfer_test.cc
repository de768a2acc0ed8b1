#include "drivers/cia301/sdo_transfer.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

using State = SdoTransfer::State;

CanFrame Reply(std::uint8_t command, std::uint16_t index, std::uint8_t sub, std::uint32_t value = 0) {
  CanFrame f{0x581,
             8,
             {command, static_cast<std::uint8_t>(index & 0xFF), static_cast<std::uint8_t>(index >> 8), sub}};
  for (unsigned i = 0; i < 4; ++i) f.data[4 + i] = static_cast<std::uint8_t>(value >> (8 * i));
  return f;
}

TEST(SdoTransfer, RequestsAreThoseOfCia301) {
  EXPECT_EQ(SdoReadFrame(1, 0x6041, 0), (CanFrame{0x601, 8, {0x40, 0x41, 0x60, 0x00}}));
  EXPECT_EQ(SdoWriteFrame(1, 0x6060, 0, 1, 10), (CanFrame{0x601, 8, {0x2F, 0x60, 0x60, 0x00, 10}}));
  EXPECT_EQ(SdoWriteFrame(2, 0x1017, 0, 2, 100), (CanFrame{0x602, 8, {0x2B, 0x17, 0x10, 0x00, 100}}));
  EXPECT_EQ(SdoWriteFrame(1, 0x1400, 1, 4, 0x80000201),
            (CanFrame{0x601, 8, {0x23, 0x00, 0x14, 0x01, 0x01, 0x02, 0x00, 0x80}}));
  EXPECT_EQ(SdoWriteFrame(1, 0x60C2, 2, 1, 0xFFFFFFFD), (CanFrame{0x601, 8, {0x2F, 0xC2, 0x60, 0x02, 0xFD}}));
  EXPECT_EQ(SdoAbortFrame(1, 0x1000, 0, sdo_abort::kTimeout),
            (CanFrame{0x601, 8, {0x80, 0x00, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05}}));
}

TEST(SdoTransfer, ReadsOneTwoAndFourBytes) {
  for (const auto& [command, value] :
       {std::pair{0x4F, 0x78u}, {0x4B, 0x5678u}, {0x43, 0x12345678u}, {0x42, 0x12345678u}}) {
    SdoTransfer t;
    t.StartRead(1, 0x6064, 0, 10);
    EXPECT_EQ(t.state(), State::kWaiting);
    EXPECT_TRUE(t.OnFrame(Reply(static_cast<std::uint8_t>(command), 0x6064, 0, 0x12345678)));
    EXPECT_EQ(t.state(), State::kDone);
    EXPECT_EQ(t.value(), value);
  }
}

TEST(SdoTransfer, WriteIsDoneWhenAcknowledged) {
  SdoTransfer t;
  t.StartWrite(1, 0x6060, 0, 1, 10, 10);
  EXPECT_TRUE(t.OnFrame(Reply(0x60, 0x6060, 0)));
  EXPECT_EQ(t.state(), State::kDone);
}

TEST(SdoTransfer, AbortKeepsTheCode) {
  SdoTransfer t;
  t.StartRead(1, 0x60C2, 1, 10);
  EXPECT_TRUE(t.OnFrame(Reply(0x80, 0x60C2, 1, sdo_abort::kNoObject)));
  EXPECT_EQ(t.state(), State::kAborted);
  EXPECT_EQ(t.abort_code(), sdo_abort::kNoObject);
  EXPECT_EQ(SdoAbortText(t.abort_code()), "object does not exist in the object dictionary");
  EXPECT_EQ(SdoAbortText(0xDEADBEEF), "unknown abort code");
}

TEST(SdoTransfer, PassesOverWhatIsNotItsReply) {
  SdoTransfer t;
  t.StartRead(1, 0x6064, 0, 10);
  EXPECT_FALSE(t.OnFrame(Reply(0x43, 0x6063, 0, 1)));
  EXPECT_FALSE(t.OnFrame(Reply(0x43, 0x6064, 1, 1)));
  CanFrame other = Reply(0x43, 0x6064, 0, 1);
  other.id = 0x582;
  EXPECT_FALSE(t.OnFrame(other));
  CanFrame too_short = Reply(0x43, 0x6064, 0, 1);
  too_short.length = 4;
  EXPECT_FALSE(t.OnFrame(too_short));
  EXPECT_EQ(t.state(), State::kWaiting);
}

TEST(SdoTransfer, ASegmentedReplyIsNoAbortOfTheDrive) {
  SdoTransfer t;
  t.StartRead(1, 0x1008, 0, 10);
  EXPECT_TRUE(t.OnFrame(Reply(0x41, 0x1008, 0, 20)));
  EXPECT_EQ(t.state(), State::kSegmented);
  EXPECT_EQ(t.value(), 20u) << "bytes";
  EXPECT_EQ(t.abort_code(), sdo_abort::kLengthTooHigh) << "what to tell the drive";
  t.StartRead(1, 0x1008, 0, 10);
  EXPECT_TRUE(t.OnFrame(Reply(0x40, 0x1008, 0, 20)));
  EXPECT_EQ(t.state(), State::kSegmented);
  EXPECT_EQ(t.value(), 0u) << "it does not say how many";
}

TEST(SdoTransfer, AReplyToSomethingElseIsNoAbortOfTheDrive) {
  SdoTransfer t;
  t.StartRead(1, 0x6061, 0, 10);
  EXPECT_TRUE(t.OnFrame(Reply(0x60, 0x6061, 0)));
  EXPECT_EQ(t.state(), State::kUnexpected);
  EXPECT_EQ(t.value(), 0x60u);
}

TEST(SdoTransfer, TimesOutAndSaysHowLongItWaited) {
  SdoTransfer t;
  t.StartRead(1, 0x6064, 0, 10);
  t.Elapse(9);
  EXPECT_EQ(t.state(), State::kWaiting);
  t.Elapse(1);
  EXPECT_EQ(t.state(), State::kTimedOut);
  EXPECT_EQ(t.waited_cycles(), 10u);
  EXPECT_FALSE(t.OnFrame(Reply(0x43, 0x6064, 0, 1))) << "too late";
}

}  // namespace
}  // namespace contour
