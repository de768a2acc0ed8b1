#include "drivers/can/socketcan_bus.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

// Runs in the guest (tests/guest), on a vcan0 of its own that may be taken down.
namespace contour {
namespace {

std::int64_t Now_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

CanFrame Frame(std::uint16_t id, std::uint8_t tag) { return {id, 8, {tag, 1, 2, 3, 4, 5, 6, 7}}; }

bool Shell(const char* command) { return std::system(command) == 0; }

class OnVcan : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(Shell("ip link set vcan0 up")); }
  /// Receives until `count` frames are in or a second has gone by.
  static std::size_t Take(SocketCanBus& bus, std::span<StampedFrame> frames, std::size_t count) {
    std::size_t n = 0;
    const std::int64_t deadline = Now_ns() + 1'000'000'000;
    const int fd = bus.fd();
    while (n < count && Now_ns() < deadline) {
      if (WaitReadable(std::span(&fd, 1), deadline)) n += bus.Receive(0, frames.subspan(n));
    }
    return n;
  }
};

TEST_F(OnVcan, ABatchArrivesInOrderWithTimeStampsOfTheLoopsClock) {
  SocketCanBus a("vcan0");
  SocketCanBus b("vcan0");
  EXPECT_TRUE(a.State().up);
  std::array<CanFrame, 20> batch;
  for (std::uint8_t i = 0; i < batch.size(); ++i) batch[i] = Frame(static_cast<std::uint16_t>(0x300 - i), i);
  const std::int64_t before = Now_ns();
  ASSERT_EQ(a.Send(0, batch), batch.size());
  std::array<StampedFrame, 64> got;
  ASSERT_EQ(Take(b, got, batch.size()), batch.size());
  const std::int64_t after = Now_ns();
  for (std::size_t i = 0; i < batch.size(); ++i) {
    EXPECT_EQ(got[i].frame, batch[i]);
    EXPECT_GE(got[i].stamp_ns, before - 1'000'000);
    EXPECT_LE(got[i].stamp_ns, after + 1'000'000);
  }
  EXPECT_EQ(a.Receive(0, got), 0u) << "its own frames do not come back";
  EXPECT_EQ(b.State().frames_received, batch.size());
  EXPECT_EQ(a.State().frames_sent, batch.size());
}

TEST_F(OnVcan, OfItsOwnFramesOnlySyncComesBack) {
  constexpr std::array<int, 1> kNodes{1};
  SocketCanBus a("vcan0", kNodes);
  SocketCanBus b("vcan0");
  const std::array<CanFrame, 3> batch{Frame(0x201, 0), Frame(0x080, 0), Frame(0x601, 0)};
  const std::int64_t before = Now_ns();
  ASSERT_EQ(a.Send(0, batch), batch.size());
  std::array<StampedFrame, 64> got;
  ASSERT_EQ(Take(a, got, 1), 1u);
  EXPECT_EQ(got[0].frame.id, kOwnFrame | 0x080);
  EXPECT_GE(got[0].stamp_ns, before - 1'000'000);
  EXPECT_LE(got[0].stamp_ns, Now_ns() + 1'000'000);
  EXPECT_EQ(a.Receive(0, got), 0u);
  EXPECT_EQ(a.State().frames_received, 0u);
  // Another's on this computer is another's.
  ASSERT_EQ(Take(b, got, 3), 3u);
  ASSERT_EQ(b.Send(0, std::span(&batch[1], 1)), 1u);
  ASSERT_EQ(Take(a, got, 1), 1u);
  EXPECT_EQ(got[0].frame.id, 0x080);
}

TEST_F(OnVcan, ALinkThatGoesDownIsSeenAndRecoveredFrom) {
  SocketCanBus a("vcan0");
  SocketCanBus b("vcan0");
  std::array<StampedFrame, 64> got;
  const std::array<CanFrame, 2> batch{Frame(0x201, 0), Frame(0x080, 1)};
  ASSERT_TRUE(Shell("ip link set vcan0 down"));
  a.Receive(0, got);
  EXPECT_FALSE(a.State().up);
  EXPECT_EQ(a.Send(0, batch), 0u);
  EXPECT_FALSE(a.State().up);
  EXPECT_EQ(a.State().send_failures, 2u);
  ASSERT_TRUE(Shell("ip link set vcan0 up"));
  b.Receive(0, got);
  EXPECT_EQ(a.Send(0, batch), 2u);
  EXPECT_TRUE(a.State().up);
  EXPECT_EQ(Take(b, got, 2), 2u);
  EXPECT_TRUE(b.State().up);
}

// As `ip link set can0 down`, `up`: the controller begins anew, and no error frame says so.
TEST_F(OnVcan, ALinkThatComesUpAgainHasAControllerWithoutErrors) {
  SocketCanBus a("vcan0");
  std::array<StampedFrame, 4> got;
  const CanFrame f = Frame(0x201, 0);
  const int fd = a.fd();
  const auto read = [&] {
    const std::int64_t deadline = Now_ns() + 1'000'000'000;
    while (a.State().error_frames == 0 && Now_ns() < deadline)
      if (WaitReadable(std::span(&fd, 1), deadline)) a.Receive(0, got);
  };
  ASSERT_TRUE(Shell("cansend vcan0 20000204#0020000000008207 && cansend vcan0 20000040#0000000000000000"));
  read();
  a.Receive(0, got);
  EXPECT_EQ(a.State().errors, ControllerErrors::kPassive);
  EXPECT_EQ(a.State().transmit_errors, 130);
  EXPECT_TRUE(a.State().bus_off);
  // One more is waiting unread when the interface is set down.
  ASSERT_TRUE(Shell("cansend vcan0 20000204#0020000000008307 && ip link set vcan0 down"));
  for (int i = 0; i < 3; ++i) a.Receive(0, got);
  EXPECT_FALSE(a.State().up);
  EXPECT_EQ(a.State().transmit_errors, 130) << "as it was when it was stopped";
  EXPECT_EQ(a.State().error_frames, 3U);
  ASSERT_TRUE(Shell("ip link set vcan0 up"));
  EXPECT_EQ(a.Send(0, std::span(&f, 1)), 1u);
  EXPECT_TRUE(a.State().up);
  EXPECT_EQ(a.State().errors, ControllerErrors::kActive);
  EXPECT_EQ(a.State().transmit_errors, 0);
  EXPECT_EQ(a.State().receive_errors, 0);
  EXPECT_FALSE(a.State().bus_off);
  EXPECT_EQ(a.State().bus_offs, 1U);
  // What the controller says before anything could be sent is of its new life.
  ASSERT_TRUE(Shell("ip link set vcan0 down"));
  a.Receive(0, got);
  ASSERT_TRUE(Shell("ip link set vcan0 up && cansend vcan0 20000204#0008000000000060"));
  for (int i = 0; i < 100 && a.State().error_frames == 3; ++i)
    if (WaitReadable(std::span(&fd, 1), Now_ns() + 10'000'000)) a.Receive(0, got);
  EXPECT_EQ(a.Send(0, std::span(&f, 1)), 1u);
  EXPECT_EQ(a.State().errors, ControllerErrors::kWarning);
  EXPECT_EQ(a.State().receive_errors, 96);
}

TEST_F(OnVcan, AnInterfaceThatVanishesIsBoundAgain) {
  SocketCanBus a("vcan0");
  const CanFrame f = Frame(0x201, 0);
  ASSERT_TRUE(Shell("ip link del vcan0"));
  std::array<StampedFrame, 4> got;
  a.Receive(0, got);
  EXPECT_EQ(a.Send(0, std::span(&f, 1)), 0u);
  EXPECT_FALSE(a.State().up);
  ASSERT_TRUE(Shell("ip link add dev vcan0 type vcan && ip link set vcan0 up"));
  std::size_t sent = 0;
  for (int i = 0; i < 200 && sent == 0; ++i) sent = a.Send(0, std::span(&f, 1));
  EXPECT_EQ(sent, 1u);
  EXPECT_TRUE(a.State().up);
}

TEST_F(OnVcan, BusOffComesAsAnErrorFrameAndIsSeenOnce) {
  SocketCanBus a("vcan0");
  SocketCanBus b("vcan0");
  ASSERT_TRUE(Shell("cansend vcan0 20000040#0000000000000000 && cansend vcan0 181#00"));
  std::array<StampedFrame, 4> got;
  ASSERT_EQ(Take(a, got, 1), 1u);
  EXPECT_TRUE(a.State().bus_off) << "data of the same batch does not hide it";
  EXPECT_EQ(a.State().error_frames, 1u);
  const CanFrame f = Frame(0x182, 0);
  b.Send(0, std::span(&f, 1));
  ASSERT_EQ(Take(a, got, 1), 1u);
  EXPECT_FALSE(a.State().bus_off);
}

TEST_F(OnVcan, FramesThatAreNotOursArePassedOver) {
  SocketCanBus a("vcan0");
  ASSERT_TRUE(Shell("cansend vcan0 12345678#11 && cansend vcan0 123#R && cansend vcan0 181#2211"));
  std::array<StampedFrame, 4> got;
  ASSERT_EQ(Take(a, got, 1), 1u);
  EXPECT_EQ(got[0].frame.id, 0x181);
  EXPECT_EQ(got[0].frame.length, 2);
}

/// Frames that this kernel dropped on its own, before any socket could count them, since it was started.
std::size_t DroppedOnTheWay() {
  std::ifstream cpus("/proc/net/softnet_stat");
  std::size_t sum = 0, processed = 0, dropped = 0;
  for (std::string line; std::getline(cpus, line); sum += dropped)
    std::istringstream(line) >> std::hex >> processed >> dropped;
  return sum;
}

TEST_F(OnVcan, LostFramesAreCounted) {
  SocketCanBus a("vcan0");
  SocketCanBus b("vcan0");
  const std::size_t dropped_before = DroppedOnTheWay();
  const std::vector<CanFrame> batch(64, Frame(0x181, 0));
  for (int i = 0; i < 1000; ++i) a.Send(0, batch);
  std::array<StampedFrame, 64> got;
  std::size_t received = 0;
  const auto unaccounted = [&] {
    return a.State().frames_sent - received - b.State().receive_overflows -
           (DroppedOnTheWay() - dropped_before);
  };
  // The kernel tells of the loss with a later frame, and on a busy host it is late itself.
  for (int tries = 0; tries < 1000 && unaccounted() != 0; ++tries) {
    a.Send(0, std::span(batch).first(1));
    received += Take(b, got, 1);
    for (std::size_t n = 0; (n = b.Receive(0, got)) > 0;) received += n;
  }
  EXPECT_EQ(unaccounted(), 0u);
  EXPECT_GT(b.State().receive_overflows, 0u);
}

}  // namespace
}  // namespace contour
