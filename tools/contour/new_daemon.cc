#include "tools/contour/new_daemon.h"

#include <stdexcept>
#include <thread>

#include "core/exit_status.h"

namespace contour {
namespace {

constexpr std::chrono::milliseconds kLookEvery{50};

}  // namespace

std::unique_ptr<ControlClient> ConnectToNewDaemon(const std::function<ControlClient()>& connect,
                                                  std::chrono::steady_clock::time_point deadline) {
  for (;;) {
    try {
      auto client = std::make_unique<ControlClient>(connect());
      client->Ask({{"request", "status"}});
      return client;
    } catch (const EnvironmentError&) {
      // Not yet there.
    } catch (const ConnectionLost&) {
      // That was the old one.
    }
    if (std::chrono::steady_clock::now() > deadline)
      throw std::runtime_error("contourd ended and did not begin anew; its messages say why");
    std::this_thread::sleep_for(kLookEvery);
  }
}

}  // namespace contour
