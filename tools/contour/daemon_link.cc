#include "tools/contour/daemon_link.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include "daemon/control_socket/socket_path.h"

namespace contour {
namespace {

constexpr std::chrono::milliseconds kLookAgain{20};
/// Longer than the machine gives its drives before it says what is wrong with them.
constexpr std::chrono::seconds kStartLimit{60};
/// A line has 64 KiB at most, and a character up to six bytes in it.
constexpr std::size_t kPiece_bytes = 8000;

/// The length of a piece that begins at `begin` and does not end within a UTF-8 sequence.
std::size_t PieceLength(std::string_view text, std::size_t begin) {
  if (text.size() - begin <= kPiece_bytes) return text.size() - begin;
  std::size_t length = kPiece_bytes;
  for (int back = 0; back < 3 && (static_cast<unsigned char>(text[begin + length]) & 0xC0u) == 0x80u; ++back)
    --length;
  return length;
}

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

nlohmann::json RunProgram(ControlClient& client, nlohmann::json request) {
  const std::string text = request.at("text");
  if (text.size() <= kPiece_bytes) return AskOrThrow(client, request);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = PieceLength(text, at);
    AskOrThrow(client, {{"request", "upload"}, {"first", at == 0}, {"text", text.substr(at, length)}});
    at += length;
  }
  request.erase("text");
  request["uploaded"] = true;
  return AskOrThrow(client, request);
}

nlohmann::json Status(ControlClient& client) {
  return AskOrThrow(client, {{"request", "status"}}).at("status");
}

void Attend(ControlClient& client, bool on) { AskOrThrow(client, {{"request", "attend"}, {"on", on}}); }

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

nlohmann::json StatusOnceStarted(ControlClient& client) {
  const auto starts = [](const nlohmann::json& s) {
    return s.at("state") == "Starting" || (s.at("state") == "Off" && s.at("reason") == "none");
  };
  nlohmann::json status = Status(client);
  if (!starts(status)) return status;
  std::cerr << "the machine is " << StateSentence(status) << "; waiting for its drives to come up\n";
  return WaitForStatus(
      client, [&](const nlohmann::json& s) { return !starts(s); }, kStartLimit);
}

std::string StateSentence(const nlohmann::json& status) {
  const std::string state = status.at("state");
  const std::string why = status.at("reason_text");
  return why.empty() ? state : state + ": " + why;
}

}  // namespace contour
