#include "drivers/cia301/messages.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

TEST(Messages, AreThoseOfCia301) {
  EXPECT_EQ(NmtFrame(NmtCommand::kStart, 5), (CanFrame{0x000, 2, {0x01, 5}}));
  EXPECT_EQ(NmtFrame(NmtCommand::kResetCommunication, 0), (CanFrame{0x000, 2, {0x82, 0}}));
  EXPECT_EQ(NmtFrame(NmtCommand::kEnterPreOperational, 1), (CanFrame{0x000, 2, {0x80, 1}}));
  EXPECT_EQ(SyncFrame(), (CanFrame{0x080, 0, {}}));
  EXPECT_EQ(HeartbeatFrame(0x7F, NmtState::kOperational), (CanFrame{0x77F, 1, {0x05}}));
  EXPECT_EQ(EmergencyFrame(3, {0x8250, 0x11}), (CanFrame{0x083, 8, {0x50, 0x82, 0x11}}));
}

TEST(Messages, Decode) {
  EXPECT_EQ(HeartbeatState({0x701, 1, {0x7F}}), NmtState::kPreOperational);
  EXPECT_EQ(HeartbeatState({0x701, 1, {0x85}}), NmtState::kOperational)
      << "the toggle bit is not part of the state";
  EXPECT_EQ(HeartbeatState({0x701, 1, {0x00}}), NmtState::kBootUp);
  EXPECT_EQ(HeartbeatState({0x701, 0, {}}), NmtState::kUnknown);
  const Emergency e = DecodeEmergency({0x081, 8, {0x30, 0x81, 0x10}});
  EXPECT_EQ(e.error_code, 0x8130);
  EXPECT_EQ(e.error_register, 0x10);
}

TEST(Messages, NumbersAreLittleEndian) {
  CanFrame f{0, 8, {}};
  PutU32(f, 2, 0x12345678);
  EXPECT_EQ(f, (CanFrame{0, 8, {0, 0, 0x78, 0x56, 0x34, 0x12}}));
  EXPECT_EQ(GetU32(f, 2), 0x12345678u);
  EXPECT_EQ(GetU16(f, 4), 0x1234);
}

}  // namespace
}  // namespace contour
