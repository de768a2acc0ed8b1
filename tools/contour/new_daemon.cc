#include "tools/contour/new_daemon.h"

#include <poll.h>

#include <stdexcept>
#include <thread>

#include "core/exit_status.h"

namespace contour {
namespace {

constexpr std::chrono::milliseconds kLookEvery{50};
constexpr const char* kEnded = "contourd ended and did not begin anew; its messages say why";

bool HasEnded(const Descriptor& process) {
  pollfd polled{process.get(), POLLIN, 0};
  return process.get() >= 0 && ::poll(&polled, 1, 0) > 0;
}

}  // namespace

std::unique_ptr<ControlClient> ConnectToNewDaemon(const std::function<ControlClient()>& connect,
                                                  const Descriptor& process,
                                                  std::chrono::steady_clock::time_point deadline) {
  for (;;) {
    const bool ended = HasEnded(process);  // before the look: of another process, a new one may answer
    try {
      auto client = std::make_unique<ControlClient>(connect());
      client->Ask({{"request", "status"}});
      return client;
    } catch (const EnvironmentError&) {
      // Not yet there.
    } catch (const ConnectionLost&) {
      // That was the old one.
    }
    if (ended) throw std::runtime_error(kEnded);
    if (std::chrono::steady_clock::now() > deadline)
      throw std::runtime_error(
          "contourd has not begun anew in time, and has not ended; its messages say why");
    std::this_thread::sleep_for(kLookEvery);
  }
}

void BeginAnew(std::unique_ptr<ControlClient>& client, const nlohmann::json& request,
               const std::function<ControlClient()>& connect,
               std::chrono::steady_clock::time_point deadline) {
  const Descriptor process = client->Daemon();
  // Its end of the connection closes when it ends, at times before its answer has come.
  try {
    const nlohmann::json reply = client->Ask(request);
    if (!reply.value("ok", false)) throw BeginRefused(reply.value("error", ""));
    while (std::chrono::steady_clock::now() < deadline) client->Listen(kLookEvery);
    throw std::runtime_error("contourd did not begin anew");
  } catch (const ConnectionLost&) {
    // As was asked.
  }
  for (;;) {
    try {
      client = ConnectToNewDaemon(connect, process, deadline);
      for (;;) {
        const nlohmann::json reply = client->Ask({{"request", "status"}});
        const std::string state = reply.at("status").at("state");
        if (state == "Idle") return;
        if (std::chrono::steady_clock::now() > deadline)
          throw std::runtime_error("contourd began anew, but is " + state);
        std::this_thread::sleep_for(kLookEvery);
      }
    } catch (const ConnectionLost&) {
      // What was asked for did not come up, and it begins once more without.
    }
  }
}

}  // namespace contour
