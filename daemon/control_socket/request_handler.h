#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "daemon/control_socket/operator_desk.h"

namespace contour {

/// What a client has subscribed to.
struct Subscriptions {
  bool rows = false;
  bool attends = false;  ///< the machine is not to go on without it
  std::optional<int> watch_period_ms;
};

/// Who answers a request: most wait for the cycle or for each other; a stop and a disable wait behind none of
/// them.
enum class RequestClass { kAtOnce, kWaits, kStop, kDisable, kUpload };

/// What a line says before anything is done about it.
struct RequestHead {
  RequestClass kind = RequestClass::kAtOnce;
  bool status = false;
  bool leads_to_motion = false;  ///< enable, run: a stop makes it void
  bool uploaded = false;         ///< a run whose program came before, in pieces
};
RequestHead HeadOf(std::string_view line) noexcept;

inline constexpr const char* kStopCameFirst = "it has not been carried out: a stop came first";

/// A piece of a program. Nothing when the line is none.
struct UploadPiece {
  bool first = false;  ///< what came before is forgotten
  std::string text;
};
std::optional<UploadPiece> PieceIn(std::string_view line) noexcept;

/// One line from a client in, the answer out. Whatever the line holds, the answer is a JSON object with "ok",
/// and with "error" when that is false; nothing is thrown. docs/operating.md describes the requests.
/// `uploaded`: the program that came in pieces, for a run that says so, which takes it.
nlohmann::json Handle(std::string_view line, OperatorDesk& desk, Subscriptions& subscriptions,
                      const std::stop_token& unwanted = {}, std::string* uploaded = nullptr) noexcept;

/// The answer that refuses a line, and one that accepts it with a key more.
nlohmann::json Refuse(std::string_view line, const std::string& why) noexcept;
nlohmann::json AcceptPiece(std::string_view line, std::size_t bytes) noexcept;

}  // namespace contour
