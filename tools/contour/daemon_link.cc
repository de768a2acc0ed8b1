#include "tools/contour/daemon_link.h"

#include <CLI/CLI.hpp>
#include <stdexcept>
#include <thread>

#include "daemon/control_socket/socket_path.h"

namespace contour {
namespace {

constexpr std::chrono::milliseconds kLookAgain{20};

}  // namespace

void AddSocketOption(CLI::App& sub, std::string& path) {
  sub.add_option("--socket", path, "Socket of the daemon; default " + DefaultSocketPath().string());
}

ControlClient ConnectToDaemon(const std::string& path) {
  return ControlClient(path.empty() ? DefaultSocketPath() : std::filesystem::path(path));
}

nlohmann::json AskOrThrow(ControlClient& client, const nlohmann::json& request) {
  nlohmann::json reply = client.Ask(request);
  if (!reply.value("ok", false))
    throw std::runtime_error(request.at("request").get<std::string>() +
                             " refused: " + reply.value("error", ""));
  return reply;
}

nlohmann::json Status(ControlClient& client) {
  return AskOrThrow(client, {{"request", "status"}}).at("status");
}

nlohmann::json WaitForStatus(ControlClient& client, const std::function<bool(const nlohmann::json&)>& done,
                             std::chrono::seconds limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  for (;;) {
    nlohmann::json status = Status(client);
    if (done(status)) return status;
    if (std::chrono::steady_clock::now() >= deadline)
      throw std::runtime_error("still " + StateSentence(status) + " after " + std::to_string(limit.count()) +
                               " s");
    std::this_thread::sleep_for(kLookAgain);
  }
}

std::string StateSentence(const nlohmann::json& status) {
  const std::string state = status.at("state");
  const std::string why = status.at("reason_text");
  return why.empty() ? state : state + ": " + why;
}

}  // namespace contour
