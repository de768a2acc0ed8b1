#include "daemon/control_socket/request_handler.h"

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace contour {
namespace {

using nlohmann::json;

constexpr int kShortestWatch_ms = 20;
constexpr int kLongestWatch_ms = 60'000;
/// A request is an object of plain values. The parser would follow a line of brackets to its end.
constexpr int kDeepest = 8;
constexpr int kMostLines = 100'000'000;

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

/// Not a name: that would be read as a file of the daemon's computer, whoever may see that.
void RequireYamlKeys(const std::string& text, const std::string& what) {
  const bool block = text.find(": ") != std::string::npos || text.find(":\n") != std::string::npos ||
                     text.find(":\r") != std::string::npos;
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const bool keys = text.empty() || block || (first != std::string::npos && text[first] == '{');
  if (!keys) throw BadRequest(what + " must be keys and values as YAML, as in \"lead_mm: 5\"");
}

bool Flag(const json& request, const char* key) {
  const auto at = request.find(key);
  if (at == request.end() || !at->is_boolean())
    throw BadRequest(std::string("\"") + key + "\" must be there and be true or false");
  return at->get<bool>();
}

int Line(const json& request, const char* key) {
  const auto at = request.find(key);
  if (!at->is_number_integer() || *at < 1 || *at > kMostLines)
    throw BadRequest(std::string("\"") + key + "\" must be the number of a line");
  return at->get<int>();
}

json Reply(const Answer& answer) {
  if (!answer.accepted) return {{"ok", false}, {"error", answer.reason}, {"sequence", answer.sequence}};
  json reply{{"ok", true}, {"sequence", answer.sequence}};
  if (!answer.reason.empty()) reply["text"] = answer.reason;
  return reply;
}

json Run(const json& request, OperatorDesk& desk, const std::stop_token& unwanted, std::string* uploaded) {
  ProgramUpload upload;
  upload.name = Text(request, "name");
  upload.format = Text(request, "format");
  if (request.contains("uploaded") && Flag(request, "uploaded")) {
    if (uploaded == nullptr) throw BadRequest("\"uploaded\" is true and nothing has been uploaded");
    upload.text = std::move(*uploaded);
  } else {
    upload.text = Text(request, "text");
  }
  if (request.contains("controller")) upload.controller = Text(request, "controller");
  if (request.contains("forget")) upload.forget = Flag(request, "forget");
  if (request.contains("from_here")) upload.from_here = Flag(request, "from_here");
  if (request.contains("single_block")) upload.part.single_block = Flag(request, "single_block");
  if (request.contains("optional_stop")) upload.part.optional_stop = Flag(request, "optional_stop");
  if (request.contains("block_delete")) upload.part.block_delete = Flag(request, "block_delete");
  if (request.contains("go_there")) upload.part.go_there = Flag(request, "go_there");
  if (request.contains("from_line")) upload.part.from_line = Line(request, "from_line");
  if (upload.format != "yaml" && upload.format != "ngc")
    throw BadRequest("\"format\" must be \"yaml\" or \"ngc\"");
  const Answer answer = desk.Run(upload, unwanted);
  json reply = Reply(answer);
  if (answer.accepted) {
    reply["program_id"] = answer.program_id;
    reply["start_m"] = std::vector<double>(answer.start_m.begin(), answer.start_m.end());
    reply["zero_m"] = std::vector<double>(answer.zero_m.begin(), answer.zero_m.end());
    reply["zero_set"] = answer.zero_set;
    reply["learnt_passes"] = answer.learnt_passes;
    if (answer.learnt_passes > 0) reply["best_peak_um"] = answer.best_peak_um;
  }
  return reply;
}

json Reference(const json& request, OperatorDesk& desk, const std::stop_token& unwanted) {
  const auto at = request.find("position_mm");
  if (at == request.end() || !at->is_object())
    throw BadRequest("\"position_mm\" must be there and be an object");
  std::map<std::string, double> position_mm;
  for (const auto& [axis, value] : at->items()) {
    if (!value.is_number()) throw BadRequest("\"position_mm\" must have a number for each axis");
    position_mm[axis] = value.get<double>();
  }
  return Reply(desk.Reference(position_mm, unwanted));
}

json Feed(const json& request, OperatorDesk& desk) {
  const auto at = request.find("percent");
  if (at == request.end() || !at->is_number()) throw BadRequest("\"percent\" must be there and be a number");
  return Reply(desk.Pace({{}, at->get<double>()}));
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

std::map<std::string, std::string> TextsOfAxes(const json& request, const char* key) {
  const auto at = request.find(key);
  const std::string name = std::string("\"") + key + "\"";
  if (at == request.end() || !at->is_object()) throw BadRequest(name + " must be there and be an object");
  std::map<std::string, std::string> texts;
  for (const auto& [axis, text] : at->items()) {
    if (!text.is_string()) throw BadRequest(name + " must have a text for each axis");
    texts[axis] = text.get<std::string>();
    RequireYamlKeys(texts[axis], name + " of " + axis);
  }
  return texts;
}

json LoadModel(const json& request, OperatorDesk& desk) {
  const std::string model = Text(request, "model");
  RequireYamlKeys(model, "\"model\"");
  return Reply(desk.LoadModel(Text(request, "axis"), model));
}

json ChangeMode(const json& request, OperatorDesk& desk) {
  std::map<std::string, std::string> models;
  if (request.contains("models")) models = TextsOfAxes(request, "models");
  return Reply(desk.ChangeMode(TextsOfAxes(request, "loops"), models));
}

/// Besides "request" and "id". Stop and disable are carried out whatever else is there.
const std::map<std::string, std::set<std::string>>& KeysOfRequests() {
  static const std::map<std::string, std::set<std::string>> keys{
      {"status", {}},
      {"machine_file", {}},
      {"enable", {}},
      {"pause", {}},
      {"resume", {}},
      {"feed", {"percent"}},
      {"zero", {}},
      {"reset", {}},
      {"reference", {"position_mm"}},
      {"reload", {}},
      {"load_model", {"axis", "model"}},
      {"torque_mode", {"loops", "models"}},
      {"csp_mode", {}},
      {"run",
       {"name", "format", "text", "uploaded", "controller", "forget", "from_here", "single_block",
        "optional_stop", "block_delete", "go_there", "from_line"}},
      {"watch", {"period_ms"}},
      {"attend", {"on"}},
      {"rows", {"on"}}};
  return keys;
}

/// A key that is misspelt would be a wish that nobody hears of.
void RequireKnownKeys(const json& request, const std::string& kind) {
  const auto known = KeysOfRequests().find(kind);
  if (known == KeysOfRequests().end()) return;
  for (const auto& [key, value] : request.items()) {
    if (key == "request" || key == "id" || known->second.contains(key)) continue;
    std::string allowed;
    for (const std::string& name : known->second) allowed += ", " + name;
    throw BadRequest("unknown key \"" + key + "\"; \"" + kind + "\" has request, id" + allowed);
  }
}

json Dispatch(const json& request, OperatorDesk& desk, Subscriptions& subscriptions,
              const std::stop_token& unwanted, std::string* uploaded) {
  const std::string kind = Text(request, "request");
  RequireKnownKeys(request, kind);
  if (kind == "status") return {{"ok", true}, {"status", ToJson(desk.Status())}};
  if (kind == "machine_file") return {{"ok", true}, {"yaml", desk.MachineFile()}};
  if (kind == "enable") return Reply(desk.Enable(unwanted));
  if (kind == "disable") return Reply(desk.Disable());
  if (kind == "stop") return Reply(desk.Stop());
  if (kind == "pause") return Reply(desk.Pace({true, {}}));
  if (kind == "resume") return Reply(desk.Pace({false, {}}));
  if (kind == "zero") return Reply(desk.Zero());
  if (kind == "feed") return Feed(request, desk);
  if (kind == "reset") return Reply(desk.Reset(unwanted));
  if (kind == "reference") return Reference(request, desk, unwanted);
  if (kind == "reload") {
    const Answer answer = desk.Reload();
    json reply = Reply(answer);
    if (answer.accepted) reply["text"] = answer.reason;
    return reply;
  }
  if (kind == "load_model") return LoadModel(request, desk);
  if (kind == "torque_mode") return ChangeMode(request, desk);
  if (kind == "csp_mode") return Reply(desk.LeaveToDrives());
  if (kind == "run") return Run(request, desk, unwanted, uploaded);
  if (kind == "watch") return Watch(request, subscriptions);
  if (kind == "rows") {
    subscriptions.rows = Flag(request, "on");
    return {{"ok", true}};
  }
  if (kind == "attend") {
    subscriptions.attends = Flag(request, "on");
    return {{"ok", true}};
  }
  throw BadRequest(
      "unknown request \"" + kind +
      "\"; there are status, machine_file, enable, disable, stop, pause, resume, feed, "
      "zero, reset, reference, reload, load_model, torque_mode, csp_mode, upload, run, watch, rows, attend");
}

json Refusal(const std::string& why) { return {{"ok", false}, {"error", why}}; }

bool TooDeep(std::string_view line) noexcept {
  int depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (in_text) {
      if (c == '\\') ++i;
      if (c == '"') in_text = false;
    } else if (c == '"') {
      in_text = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kDeepest) return true;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return false;
}

/// Discarded when it is none.
json Parse(std::string_view line) {
  return TooDeep(line) ? json(json::value_t::discarded) : json::parse(line, nullptr, false);
}

/// Of the request's own keys: one that is there more than once is noted. JSON leaves open which counts.
json ParseNoting(std::string_view line, std::string& repeated) {
  std::set<std::string> keys;
  const json::parser_callback_t look = [&](int depth, json::parse_event_t event, const json& parsed) {
    if (event == json::parse_event_t::key && depth == 1)
      if (const auto name = parsed.get<std::string>(); !keys.insert(name).second) repeated = name;
    return true;
  };
  return json::parse(line, look, false);
}

json WithId(json reply, const json& request) {
  if (!request.is_object()) return reply;
  if (const auto id = request.find("id"); id != request.end() && id->is_number_integer()) reply["id"] = *id;
  return reply;
}

json HandleOrThrow(std::string_view line, OperatorDesk& desk, Subscriptions& subscriptions,
                   const std::stop_token& unwanted, std::string* uploaded) {
  if (TooDeep(line)) return Refusal("a request has " + std::to_string(kDeepest) + " levels at most");
  std::string repeated;
  const json request = ParseNoting(line, repeated);
  if (request.is_discarded()) return Refusal("this line is not JSON");
  if (!request.is_object()) return Refusal("a request is a JSON object");
  const auto kind = request.find("request");
  const bool stops = kind != request.end() && (*kind == "stop" || *kind == "disable");
  if (!repeated.empty() && !stops)
    return WithId(Refusal("\"" + repeated + "\" is there more than once"), request);
  try {
    return WithId(Dispatch(request, desk, subscriptions, unwanted, uploaded), request);
  } catch (const BadRequest& e) {
    return WithId(Refusal(e.what()), request);
  }
}

/// By the thread that serves the socket: nothing of it waits.
bool AnsweredAtOnce(std::string_view kind) {
  for (const char* at_once : {"watch", "rows", "attend", "pause", "resume", "feed", "zero"})
    if (kind == at_once) return true;
  return false;
}

}  // namespace

RequestHead HeadOf(std::string_view line) noexcept {
  RequestHead head;
  try {
    const json request = Parse(line);
    if (!request.is_object()) return head;
    const std::string kind = request.value("request", std::string());
    head.status = kind == "status";
    head.leads_to_motion = kind == "enable" || kind == "run";
    if (kind == "stop") {
      head.kind = RequestClass::kStop;
    } else if (kind == "disable") {
      head.kind = RequestClass::kDisable;
    } else if (kind == "upload") {
      head.kind = RequestClass::kUpload;
    } else if (!head.status && !AnsweredAtOnce(kind)) {
      head.kind = RequestClass::kWaits;
    }
    head.uploaded = kind == "run" && request.value("uploaded", false);
  } catch (const std::exception&) {
    // A key is not what it should be: refused when its turn comes.
  }
  return head;
}

std::optional<UploadPiece> PieceIn(std::string_view line) noexcept {
  try {
    json request = Parse(line);
    UploadPiece piece;
    if (request.contains("first")) piece.first = Flag(request, "first");
    piece.text = Text(request, "text");
    return piece;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

nlohmann::json Handle(std::string_view line, OperatorDesk& desk, Subscriptions& subscriptions,
                      const std::stop_token& unwanted, std::string* uploaded) noexcept {
  try {
    return HandleOrThrow(line, desk, subscriptions, unwanted, uploaded);
  } catch (const std::exception& e) {
    return Refusal(std::string("internal error: ") + e.what());
  }
}

nlohmann::json Refuse(std::string_view line, const std::string& why) noexcept {
  return WithId(Refusal(why), Parse(line));
}

nlohmann::json AcceptPiece(std::string_view line, std::size_t bytes) noexcept {
  return WithId({{"ok", true}, {"bytes", bytes}}, Parse(line));
}

}  // namespace contour
