#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>

#include "daemon/control_socket/operator_desk.h"

namespace contour {

/// What a client has subscribed to.
struct Subscriptions {
  bool rows = false;
  std::optional<int> watch_period_ms;
};

/// Who answers a request: most wait for the cycle or for each other, and a stop waits behind none of them.
enum class RequestClass { kAtOnce, kWaits, kStop };
RequestClass ClassOf(std::string_view line) noexcept;

/// One line from a client in, the answer out. Whatever the line holds, the answer is a JSON object with "ok",
/// and with "error" when that is false; nothing is thrown. docs/operating.md describes the requests.
nlohmann::json Handle(std::string_view line, OperatorDesk& desk, Subscriptions& subscriptions) noexcept;

}  // namespace contour
