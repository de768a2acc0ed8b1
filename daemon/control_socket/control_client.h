#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "daemon/control_socket/unix_listener.h"

namespace contour {

/// The daemon went away, or what it says makes no sense.
class ConnectionLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A companion program's end of the control socket.
class ControlClient {
 public:
  /// Throws EnvironmentError when nobody listens.
  explicit ControlClient(const std::filesystem::path& socket);

  /// Sends a request and waits for its answer; messages of subscriptions that come in between go to
  /// OnMessage's function. Throws ConnectionLost.
  nlohmann::json Ask(nlohmann::json request);

  /// Receives what has been subscribed to, until a message has been handled or the time is over.
  void Listen(std::chrono::milliseconds time);

  /// The process that answers, to be polled: readable once it has ended. -1 in get() where the kernel does
  /// not tell of it.
  [[nodiscard]] Descriptor Daemon() const;

  void OnMessage(std::function<void(const nlohmann::json&)> function) { on_message_ = std::move(function); }

 private:
  [[nodiscard]] std::optional<nlohmann::json> Next(std::chrono::steady_clock::time_point deadline);
  [[nodiscard]] std::optional<std::string> TakeLine();

  Descriptor socket_;
  std::string received_;
  std::size_t searched_ = 0;
  int next_id_ = 1;
  std::function<void(const nlohmann::json&)> on_message_;
};

}  // namespace contour
