#include "daemon/service_notifier.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <string>

namespace contour {
namespace {

/// What systemd has at the other end.
class Manager {
 public:
  Manager() : path_(testing::TempDir() + "notify." + std::to_string(getpid())) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path_.c_str(), sizeof address.sun_path - 1);
    unlink(path_.c_str());
    bound_ = bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    setenv("NOTIFY_SOCKET", path_.c_str(), 1);
  }
  ~Manager() {
    unsetenv("NOTIFY_SOCKET");
    close(socket_);
    unlink(path_.c_str());
  }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;
  [[nodiscard]] bool bound() const { return bound_; }
  [[nodiscard]] std::string Heard() const {
    std::array<char, 256> text{};
    const ssize_t n = recv(socket_, text.data(), text.size(), MSG_DONTWAIT);
    return n < 0 ? "" : std::string(text.data(), static_cast<std::size_t>(n));
  }

 private:
  std::string path_;
  int socket_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  bool bound_ = false;
};

TEST(ServiceNotifier, AsksForTimeWhileItStartsAndSaysReadyOnce) {
  const Manager manager;
  ASSERT_TRUE(manager.bound());
  ServiceNotifier::StillStarting();
  EXPECT_EQ(manager.Heard(), "EXTEND_TIMEOUT_USEC=30000000");
  ServiceNotifier notifier;
  notifier.Ready();
  notifier.Ready();
  EXPECT_EQ(manager.Heard(), "READY=1");
  EXPECT_EQ(manager.Heard(), "");
}

}  // namespace
}  // namespace contour
