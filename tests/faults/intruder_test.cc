#include "tools/faults/intruder.h"

#include <gtest/gtest.h>

#include "drivers/can/loopback_bus.h"

namespace contour::faults {
namespace {

std::size_t Heard(LoopbackBus& bus, std::int64_t until_ns) {
  std::array<StampedFrame, 256> frames;
  return bus.Receive(until_ns, frames);
}

TEST(Intruder, SendsAtItsPeriodSoManyTimes) {
  Intruder intruder;
  LoopbackBus bus(1'000'000, {&intruder});
  intruder.Begin(CanFrame{0x123, 0, {}}, 1'000'000, 3, 500'000);
  EXPECT_EQ(Heard(bus, 400'000), 0U);
  EXPECT_EQ(Heard(bus, 1'000'000), 1U);
  EXPECT_EQ(Heard(bus, 10'000'000), 2U);
}

TEST(Intruder, StopsWhenItIsTold) {
  Intruder intruder;
  LoopbackBus bus(1'000'000, {&intruder});
  intruder.Begin(CanFrame{0x123, 0, {}}, 1'000'000, -1);
  EXPECT_GE(Heard(bus, 5'000'000), 4U);
  intruder.End();
  Heard(bus, 6'000'000);
  EXPECT_EQ(Heard(bus, 20'000'000), 0U);
}

TEST(Intruder, AFloodLeavesNoRoomForLowerPriority) {
  Intruder intruder;
  LoopbackBus bus(1'000'000, {&intruder});
  CanFrame loud{0x001, 8, {}};
  loud.data.fill(0x55);
  intruder.Begin(loud, 105'000, -1);
  Heard(bus, 1'000'000);
  const CanFrame ours{0x201, 8, {}};
  bus.Send(1'000'000, {&ours, 1});
  std::array<StampedFrame, 256> frames;
  EXPECT_GT(bus.Receive(10'000'000, frames), 70U) << "the bus is full of it";
}

}  // namespace
}  // namespace contour::faults
