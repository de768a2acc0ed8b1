#include "daemon/interface_lock.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <memory>
#include <string>

#include "drivers/can/socketcan_bus.h"

namespace contour {
namespace {

/// No such interface; tests of several trees may run beside each other.
std::string Name(const char* what) { return std::string(what) + std::to_string(getpid()); }

std::string Refusal(const std::string& interface) {
  try {
    const InterfaceLock lock(interface);
    return {};
  } catch (const BusUnavailable& e) {
    return e.what();
  }
}

TEST(InterfaceLock, TheSecondIsRefusedAndToldByWhom) {
  const std::string interface = Name("t");
  const InterfaceLock first(interface);
  const std::string text = Refusal(interface);
  EXPECT_NE(text.find("CAN interface " + interface), std::string::npos) << text;
  EXPECT_NE(text.find("(process " + std::to_string(getpid()) + ")"), std::string::npos) << text;
}

TEST(InterfaceLock, OthersAreFreeAndItIsFreeAgainAfterwards) {
  const std::string interface = Name("t");
  auto first = std::make_unique<InterfaceLock>(interface);
  EXPECT_EQ(Refusal(Name("u")), "");
  first.reset();
  EXPECT_EQ(Refusal(interface), "");
}

TEST(InterfaceLock, ManyWhoAskAreAllRefused) {
  const std::string interface = Name("t");
  const InterfaceLock first(interface);
  for (int i = 0; i < 50; ++i) ASSERT_NE(Refusal(interface), "");
}

TEST(InterfaceLock, AKilledHolderHoldsNothing) {
  const std::string interface = Name("k");
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    const InterfaceLock lock(interface);
    const char byte = 1;
    if (write(ready[1], &byte, 1) == 1) pause();
    _exit(1);
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  EXPECT_NE(Refusal(interface).find("(process " + std::to_string(child) + ")"), std::string::npos);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(Refusal(interface), "");
  close(ready[0]);
  close(ready[1]);
}

}  // namespace
}  // namespace contour
