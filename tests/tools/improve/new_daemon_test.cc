#include "tools/contour/new_daemon.h"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <stdexcept>
#include <string_view>

#include "core/exit_status.h"
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
  void Answer() const {
    constexpr std::string_view kAnswer = "{\"id\":1,\"ok\":true}\n";
    ASSERT_EQ(::send(served_.get(), kAnswer.data(), kAnswer.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(kAnswer.size()));
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
  EXPECT_NE(ConnectToNewDaemon(connect, Clock::now() + std::chrono::minutes(5)), nullptr);
  EXPECT_EQ(calls, 3);
}

TEST_F(NewDaemonTest, NobodyComesBack) {
  const auto connect = []() -> ControlClient { throw EnvironmentError("nobody listens"); };
  EXPECT_THROW(ConnectToNewDaemon(connect, Clock::now()), std::runtime_error);
}

}  // namespace
}  // namespace contour
