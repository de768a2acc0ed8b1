#pragma once

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "daemon/control_socket/control_client.h"

namespace CLI {
class App;
}

namespace contour {

/// `--socket PATH`, for every subcommand that talks to a running daemon.
void AddSocketOption(CLI::App& sub, std::string& path);

/// Connects to `path`, or to the default socket when it is empty. Throws EnvironmentError.
ControlClient ConnectToDaemon(const std::string& path);

/// Asks, and throws std::runtime_error with the daemon's reason when it refuses.
nlohmann::json AskOrThrow(ControlClient& client, const nlohmann::json& request);

/// Has a program run: `request` is a "run" with its text, of any size. A long one is sent in pieces. Throws
/// as AskOrThrow().
nlohmann::json RunProgram(ControlClient& client, nlohmann::json request);

/// The status, as docs/operating.md describes it.
nlohmann::json Status(ControlClient& client);

/// From now on contourd takes the torque off, after a stop on the path, should this connection end, and gives
/// a mode for commissioning back; or no longer.
void Attend(ControlClient& client, bool on);

/// Looks at the status until `done` says so or the time is over (then throws std::runtime_error naming the
/// state).
nlohmann::json WaitForStatus(ControlClient& client, const std::function<bool(const nlohmann::json&)>& done,
                             std::chrono::seconds limit);

/// The status once the drives have come up, for what begins from Idle: a daemon that was started a moment ago
/// is not refused. Waits for a minute at most, and says so on stderr; throws as WaitForStatus().
nlohmann::json StatusOnceStarted(ControlClient& client);

/// "Faulted: the emergency-stop circuit is open" or just "Ready".
std::string StateSentence(const nlohmann::json& status);

}  // namespace contour
