#include "drivers/can/socketcan_bus.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <ctime>
#include <string>

namespace contour {
namespace {

// What needs frames is tested in the guest: socketcan_bus_vcan_test.cc.

bool KernelHasCan() {
  const int fd = socket(PF_CAN, SOCK_RAW, 1);
  if (fd >= 0) close(fd);
  return fd >= 0;
}

std::int64_t Now_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

std::string WhyNot(const std::string& interface) {
  try {
    SocketCanBus bus(interface);
    return "";
  } catch (const BusUnavailable& e) {
    return e.what();
  }
}

TEST(SocketCanBus, SaysWhatIsMissing) {
  const std::string why = WhyNot("nosuchcan7");
  EXPECT_NE(why.find("nosuchcan7"), std::string::npos) << why;
  if (KernelHasCan()) {
    EXPECT_NE(why.find("no such interface"), std::string::npos) << why;
  } else {
    EXPECT_NE(why.find("no SocketCAN"), std::string::npos) << why;
    EXPECT_NE(why.find("modprobe"), std::string::npos) << why;
  }
  EXPECT_NE(WhyNot("").find("not a possible name"), std::string::npos);
  EXPECT_NE(WhyNot("a_name_much_too_long_for_linux").find("not a possible name"), std::string::npos);
}

TEST(SocketCanBus, WaitingEndsAtTheDeadline) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const std::int64_t deadline = Now_ns() + 2'000'000;
  EXPECT_FALSE(WaitReadable(std::span(ends.data(), 1), deadline));
  EXPECT_GE(Now_ns(), deadline);
  ASSERT_EQ(write(ends[1], "x", 1), 1);
  EXPECT_TRUE(WaitReadable(std::span(ends.data(), 1), Now_ns() + 1'000'000'000));
  close(ends[0]);
  close(ends[1]);
}

}  // namespace
}  // namespace contour
