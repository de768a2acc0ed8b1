#include "daemon/control_socket/control_client.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>

namespace contour {
namespace {

using Clock = std::chrono::steady_clock;

/// Longer than the daemon lets itself take for any request.
constexpr std::chrono::seconds kAnswerTime{30};

void SendAll(int socket, std::string_view text) {
  while (!text.empty()) {
    const ssize_t n = ::send(socket, text.data(), text.size(), MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw ConnectionLost("contourd closed the connection");
    text.remove_prefix(static_cast<std::size_t>(n));
  }
}

}  // namespace

ControlClient::ControlClient(const std::filesystem::path& socket) : socket_(ConnectUnix(socket)) {}

nlohmann::json ControlClient::Ask(nlohmann::json request) {
  const int id = next_id_++;
  request["id"] = id;
  SendAll(socket_.get(), request.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n');
  const auto deadline = Clock::now() + kAnswerTime;
  while (const auto message = Next(deadline)) {
    if (message->contains("ok") && message->value("id", id) == id) return *message;
    if (on_message_) on_message_(*message);
  }
  throw ConnectionLost("contourd did not answer within 30 s");
}

void ControlClient::Listen(std::chrono::milliseconds time) {
  const auto message = Next(Clock::now() + time);
  if (message && on_message_) on_message_(*message);
}

Descriptor ControlClient::Daemon() const {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (::getsockopt(socket_.get(), SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0 || peer.pid <= 0) return {};
  return Descriptor(static_cast<int>(::syscall(SYS_pidfd_open, peer.pid, 0)));
}

std::optional<nlohmann::json> ControlClient::Next(Clock::time_point deadline) {
  std::array<char, 65536> buffer;
  for (;;) {
    if (const auto line = TakeLine()) {
      auto message = nlohmann::json::parse(*line, nullptr, false);
      if (!message.is_object()) throw ConnectionLost("what answers on the socket is no contourd");
      return message;
    }
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return std::nullopt;
    pollfd polled{socket_.get(), POLLIN, 0};
    const int ready = ::poll(&polled, 1, static_cast<int>(std::min<long>(left, 60'000)));
    if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
    const ssize_t n = ::recv(socket_.get(), buffer.data(), buffer.size(), 0);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw ConnectionLost("contourd closed the connection");
    received_.append(buffer.data(), static_cast<std::size_t>(n));
  }
}

std::optional<std::string> ControlClient::TakeLine() {
  const std::size_t end = received_.find('\n', searched_);
  if (end == std::string::npos) {
    searched_ = received_.size();
    return std::nullopt;
  }
  std::string line = received_.substr(0, end);
  received_.erase(0, end + 1);
  searched_ = 0;
  return line;
}

}  // namespace contour
