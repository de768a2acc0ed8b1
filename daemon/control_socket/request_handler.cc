#include "daemon/control_socket/request_handler.h"

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace contour {
namespace {

using nlohmann::json;

constexpr int kShortestWatch_ms = 20;
constexpr int kLongestWatch_ms = 60'000;

/// A request that makes no sense; the text goes to the client.
class BadRequest : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::string Text(const json& request, const char* key) {
  const auto at = request.find(key);
  if (at == request.end() || !at->is_string())
    throw BadRequest(std::string("\"") + key + "\" must be there and be a string");
  return at->get<std::string>();
}

bool Flag(const json& request, const char* key) {
  const auto at = request.find(key);
  if (at == request.end() || !at->is_boolean())
    throw BadRequest(std::string("\"") + key + "\" must be there and be true or false");
  return at->get<bool>();
}

json Reply(const Answer& answer) {
  if (!answer.accepted) return {{"ok", false}, {"error", answer.reason}, {"sequence", answer.sequence}};
  return {{"ok", true}, {"sequence", answer.sequence}};
}

json Run(const json& request, OperatorDesk& desk) {
  ProgramUpload upload;
  upload.name = Text(request, "name");
  upload.format = Text(request, "format");
  upload.text = Text(request, "text");
  if (request.contains("controller")) upload.controller = Text(request, "controller");
  if (request.contains("forget")) upload.forget = Flag(request, "forget");
  if (upload.format != "yaml" && upload.format != "ngc")
    throw BadRequest("\"format\" must be \"yaml\" or \"ngc\"");
  const Answer answer = desk.Run(upload);
  json reply = Reply(answer);
  if (answer.accepted) {
    reply["program_id"] = answer.program_id;
    reply["start_m"] = std::vector<double>(answer.start_m.begin(), answer.start_m.end());
    reply["learnt_passes"] = answer.learnt_passes;
    if (answer.learnt_passes > 0) reply["best_peak_um"] = answer.best_peak_um;
  }
  return reply;
}

json Watch(const json& request, Subscriptions& subscriptions) {
  const auto at = request.find("period_ms");
  if (at == request.end()) {
    subscriptions.watch_period_ms.reset();
    return {{"ok", true}};
  }
  if (!at->is_number_integer() || *at < kShortestWatch_ms || *at > kLongestWatch_ms)
    throw BadRequest("\"period_ms\" must be an integer from " + std::to_string(kShortestWatch_ms) + " to " +
                     std::to_string(kLongestWatch_ms));
  subscriptions.watch_period_ms = at->get<int>();
  return {{"ok", true}};
}

json Dispatch(const json& request, OperatorDesk& desk, Subscriptions& subscriptions) {
  const std::string kind = Text(request, "request");
  if (kind == "status") return {{"ok", true}, {"status", ToJson(desk.Status())}};
  if (kind == "machine_file") return {{"ok", true}, {"yaml", desk.MachineFile()}};
  if (kind == "enable") return Reply(desk.Enable());
  if (kind == "disable") return Reply(desk.Disable());
  if (kind == "stop") return Reply(desk.Stop());
  if (kind == "reset") return Reply(desk.Reset());
  if (kind == "reload") {
    const Answer answer = desk.Reload();
    json reply = Reply(answer);
    if (answer.accepted) reply["text"] = answer.reason;
    return reply;
  }
  if (kind == "run") return Run(request, desk);
  if (kind == "watch") return Watch(request, subscriptions);
  if (kind == "rows") {
    subscriptions.rows = Flag(request, "on");
    return {{"ok", true}};
  }
  throw BadRequest(
      "unknown request \"" + kind +
      "\"; there are status, machine_file, enable, disable, stop, reset, reload, run, watch, rows");
}

json Refusal(const std::string& why) { return {{"ok", false}, {"error", why}}; }

json HandleOrThrow(std::string_view line, OperatorDesk& desk, Subscriptions& subscriptions) {
  const json request = json::parse(line, nullptr, false);
  if (request.is_discarded()) return Refusal("this line is not JSON");
  if (!request.is_object()) return Refusal("a request is a JSON object");
  json reply;
  try {
    reply = Dispatch(request, desk, subscriptions);
  } catch (const BadRequest& e) {
    reply = Refusal(e.what());
  }
  if (const auto id = request.find("id"); id != request.end() && id->is_number_integer()) reply["id"] = *id;
  return reply;
}

}  // namespace

RequestClass ClassOf(std::string_view line) noexcept {
  try {
    const json request = json::parse(line, nullptr, false);
    if (!request.is_object()) return RequestClass::kAtOnce;
    const std::string kind = request.value("request", std::string());
    if (kind == "stop") return RequestClass::kStop;
    const bool at_once = kind == "status" || kind == "watch" || kind == "rows";
    return at_once ? RequestClass::kAtOnce : RequestClass::kWaits;
  } catch (const std::exception&) {
    return RequestClass::kAtOnce;  // "request" is no string: refused
  }
}

nlohmann::json Handle(std::string_view line, OperatorDesk& desk, Subscriptions& subscriptions) noexcept {
  try {
    return HandleOrThrow(line, desk, subscriptions);
  } catch (const std::exception& e) {
    return Refusal(std::string("internal error: ") + e.what());
  }
}

}  // namespace contour
