#include "tools/contour/new_daemon.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <memory>
#include <stdexcept>
#include <string_view>

#include "core/exit_status.h"
#include "tests/support/eventually.h"
#include "tests/support/scratch_directory.h"

namespace contour {
namespace {

using Clock = std::chrono::steady_clock;

class NewDaemonTest : public ::testing::Test {
 protected:
  /// A connection that the daemon takes; what it does with it is the caller's.
  ControlClient Connect() {
    ControlClient client(path_);
    served_ = listener_.Accept();
    EXPECT_GE(served_.get(), 0);
    return client;
  }
  void Answer(std::string_view answer = "{\"id\":1,\"ok\":true}\n") const {
    ASSERT_EQ(::send(served_.get(), answer.data(), answer.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(answer.size()));
  }

  test::ScratchDirectory scratch_;
  const std::filesystem::path path_ = scratch_.path() / "control.sock";
  UnixListener listener_{path_, 0600};
  Descriptor served_;
};

TEST_F(NewDaemonTest, AConnectionThatTheOldOneStillTookIsMadeAgain) {
  int calls = 0;
  const auto connect = [&] {
    if (++calls == 1) throw EnvironmentError("nobody listens");
    ControlClient client = Connect();
    if (calls == 2) served_ = Descriptor();  // it ends before it has answered
    if (calls == 3) Answer();
    return client;
  };
  EXPECT_NE(ConnectToNewDaemon(connect, {}, Clock::now() + std::chrono::minutes(5)), nullptr);
  EXPECT_EQ(calls, 3);
}

TEST_F(NewDaemonTest, NobodyComesBack) {
  const auto connect = []() -> ControlClient { throw EnvironmentError("nobody listens"); };
  EXPECT_THROW(ConnectToNewDaemon(connect, {}, Clock::now()), std::runtime_error);
}

// Drives that come up neither in the mode that was asked for nor in the machine file's own, say.
TEST_F(NewDaemonTest, AProcessThatHasEndedIsNotWaitedFor) {
  const std::filesystem::path path = scratch_.path() / "process.sock";
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    // Ends when it is asked for something.
    const UnixListener listener(path, 0600);
    pollfd polled{listener.get(), POLLIN, 0};
    ::poll(&polled, 1, -1);
    const Descriptor client = listener.Accept();
    polled.fd = client.get();
    ::poll(&polled, 1, -1);
    ::_exit(1);
  }
  std::unique_ptr<ControlClient> client;
  ASSERT_TRUE(test::Eventually([&] {
    try {
      client = std::make_unique<ControlClient>(path);
    } catch (const EnvironmentError&) {
      return false;
    }
    return true;
  }));
  try {
    BeginAnew(
        client, {{"request", "torque_mode"}},
        []() -> ControlClient { throw EnvironmentError("nobody listens"); },
        Clock::now() + std::chrono::minutes(2));
    FAIL() << "nobody came back";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string_view(e.what()).find("contourd ended"), std::string_view::npos) << e.what();
  }
  EXPECT_EQ(::waitpid(child, nullptr, 0), child);
}

TEST_F(NewDaemonTest, WhatItRefusesItGoesOnWithout) {
  auto client = std::make_unique<ControlClient>(Connect());
  Answer("{\"id\":1,\"ok\":false,\"error\":\"it is Ready\"}\n");
  try {
    BeginAnew(
        client, {{"request", "torque_mode"}}, [this] { return Connect(); },
        Clock::now() + std::chrono::minutes(5));
    FAIL() << "it was refused";
  } catch (const BeginRefused& e) {
    EXPECT_STREQ(e.what(), "it is Ready");
  }
}

TEST_F(NewDaemonTest, ItMayBeginTwiceWhereWhatWasAskedForDoesNotComeUp) {
  auto client = std::make_unique<ControlClient>(Connect());
  served_ = Descriptor();  // it ends
  int calls = 0;
  const auto connect = [&] {
    ControlClient anew = Connect();
    Answer();
    if (++calls == 1) {
      Answer("{\"id\":2,\"ok\":true,\"status\":{\"state\":\"BringUp\"}}\n");
      served_ = Descriptor();
    } else {
      Answer("{\"id\":2,\"ok\":true,\"status\":{\"state\":\"Idle\"}}\n");
    }
    return anew;
  };
  BeginAnew(client, {{"request", "torque_mode"}}, connect, Clock::now() + std::chrono::minutes(5));
  EXPECT_EQ(calls, 2);
}

}  // namespace
}  // namespace contour
