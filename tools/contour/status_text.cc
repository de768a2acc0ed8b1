#include "tools/contour/status_text.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/contour/daemon_link.h"
#include "tools/contour/text_table.h"

namespace contour {
namespace {

using nlohmann::json;

std::string Text(const json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

/// A number of the status times a factor; a dash where there is none.
std::string Number(const json& value, double factor, int decimals) {
  if (!value.is_number()) return "-";
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value.get<double>() * factor);
  return text;
}

std::string Machine(const json& s) {
  std::string text = Text(s["machine"]) + ": " + StateSentence(s) + "\n";
  text += "  controller " + Text(s["controller"]) + ", cycle " + Text(s["cycle_us"]) + " us, " +
          Text(s["clock"]) + " clock, contourd " + Text(s["version"]) + "\n";
  const std::string bring_up = Text(s["bring_up"]);
  if (!bring_up.empty() && bring_up != Text(s["reason_text"])) text += "  bring-up: " + bring_up + "\n";
  for (const json& warning : s["warnings"]) text += "  warning: " + Text(warning) + "\n";
  const std::string program = ProgramText(s);
  return program.empty() ? text : text + "  " + program + "\n";
}

std::string Axes(const json& s) {
  TextColumns table;
  table.Add({"axis", "drive", "position mm", "error um", "torque Nm", "friction N", "+-", "limit"});
  for (const json& a : s["axes"]) {
    std::string drive = Text(a["drive_state"]);
    if (a["emergency_code"] != 0) {
      char code[32];
      std::snprintf(code, sizeof code, " (EMCY %04Xh)", a["emergency_code"].get<unsigned>());
      drive += code;
    }
    if (a["feedback_fresh"] == false) drive += ", feedback old";
    if (a.value("referenced", true) == false) drive += ", not referenced (" + Text(a["reference"]) + ")";
    table.Add({Text(a["name"]), drive, Number(a["position_m"], 1e3, 4),
               Number(a["following_error_m"], 1e6, 2), Number(a["torque_Nm"], 1.0, 4),
               Number(a["friction_N"], 1.0, 1), Number(a["friction_std_N"], 1.0, 1),
               a["limit"] == "none" ? "" : Text(a["limit"])});
  }
  return table.Text();
}

/// Which causes late cycles had, and whose feedback was missing.
std::string Late(const json& s) {
  std::string text;
  if (s["late"].is_object()) {
    std::string causes;
    for (const auto& [cause, count] : s["late"]["causes"].items())
      if (count != 0) causes += (causes.empty() ? "" : ", ") + cause + " " + count.dump();
    if (!causes.empty()) text += "  late by cause: " + causes + "\n";
  }
  for (const json& a : s["axes"])
    if (a.contains("feedback") && a["feedback"]["stale_cycles"] != 0)
      text += "  feedback of " + Text(a["name"]) + " missing at " + Text(a["feedback"]["stale_cycles"]) +
              " grid points, answers within " + Number(a["feedback"]["response"]["max_us"], 1, 0) + " us\n";
  return text;
}

/// What the drives said of their errors, the newest last, and what they remember themselves.
std::string Errors(const json& s) {
  constexpr std::size_t kShown = 3;
  std::string text;
  for (const json& a : s["axes"]) {
    if (!a.contains("errors")) continue;
    const json& received = a["errors"]["received"];
    for (std::size_t i = received.size() > kShown ? received.size() - kShown : 0; i < received.size(); ++i) {
      char line[64];
      std::snprintf(line, sizeof line, "  %s: emergency 0x%04X (", Text(a["name"]).substr(0, 16).c_str(),
                    received[i]["code"].get<unsigned>());
      text += line + Text(received[i]["text"]) + "), " + Text(received[i]["reaction"]) + ", in cycle " +
              Text(received[i]["cycle"]) + "\n";
    }
    std::string stored;
    for (const json& e : a["errors"]["stored"]) {
      char code[16];
      std::snprintf(code, sizeof code, "0x%04X", e["code"].get<unsigned>());
      stored += (stored.empty() ? "" : ", ") + std::string(code) + " (" + Text(e["text"]) + ")";
    }
    if (!stored.empty()) text += "  " + Text(a["name"]) + " remembers " + stored + "\n";
  }
  return text;
}

std::string Counters(const json& s) {
  std::string text = "  cycles " + Text(s["cycles"]);
  if (!s["late_cycles"].is_null()) text += ", late " + Text(s["late_cycles"]);
  text += ", stale " + Text(s["stale_cycles"]) + ", skipped " + Text(s["skipped_grid_points"]) +
          ", dropped telemetry " + Text(s["dropped_telemetry"]) + "\n";
  if (s["clock"] != "wall") return text;
  TextColumns table;
  table.Add({"us", "median", "99 %", "99.9 %", "largest"});
  const auto row = [&](const char* name, const char* key) {
    const json& t = s["timing"][key];
    table.Add({name, Number(t["p50_us"], 1, 0), Number(t["p99_us"], 1, 0), Number(t["p999_us"], 1, 0),
               Number(t["max_us"], 1, 1)});
  };
  row("woken after the grid point", "wakeup_late");
  row("receiving", "receiving");
  row("estimating", "estimating");
  row("deciding", "deciding");
  row("sending", "sending");
  row("sent after the grid point", "sent");
  return text + table.Text() + Late(s);
}

std::string BusWord(const json& b) {
  if (b["bus_off"] == true) return "bus off";
  if (b["up"] != true) return "down";
  const std::string errors = b.value("controller_errors", "active");
  std::string word = errors == "active" ? "up" : "up, controller error " + errors;
  if (const auto offs = b.value("bus_offs", 0U); offs != 0)
    word += ", was bus-off " + std::to_string(offs) + (offs == 1 ? " time" : " times");
  return word;
}

std::string Buses(const json& s) {
  std::string text;
  for (const json& b : s["buses"]) {
    text += "  bus " + Text(b["name"]) + " on " + Text(b["interface"]) + ": " + BusWord(b) + ", received " +
            Text(b["frames_received"]) + ", sent " + Text(b["frames_sent"]) + ", not sent " +
            Text(b["send_failures"]) + ", error frames " + Text(b["error_frames"]) + ", overflows " +
            Text(b["receive_overflows"]) + ", dropped " + Text(b["frames_dropped"]) + "\n";
    if (b.value("foreign_sdo_requests", 0U) != 0)
      text +=
          "      somebody else asked our drives by SDO: " + Text(b["foreign_sdo_requests"]) + " requests\n";
    if (const json nodes = b.value("other_nodes", json::array()); !nodes.empty())
      text += "      other nodes: " + nodes.dump() + "\n";
  }
  return text;
}

std::string Around(const json& s) {
  std::string text;
  if (const json& io = s["io"]; !io.is_null()) {
    text += std::string("  I/O ") + (io["connected"] == true ? "connected" : "not connected") +
            (io["fresh"] == true ? "" : ", data old") + ", emergency stop " +
            (io["emergency_stop_ok"] == true ? "closed" : "OPEN") + ", enable chain " +
            (io["enable_chain_ok"] == true ? "closed" : "OPEN") + ", screw " +
            Number(io["screw_temperature_degC"], 1.0, 1) + " degC, polls " + Text(io["polls"]) +
            ", failures " + Text(io["failures"]) + "\n";
    if (io["connected"] == false && !Text(io["last_error"]).empty())
      text += "      " + Text(io["last_error"]) + "\n";
  }
  if (const json& lcm = s["lcm"]; !lcm.is_null()) {
    text += "  LCM messages " + Text(lcm["messages"]) + ", not sent " + Text(lcm["failures"]) + "\n";
    if (!Text(lcm["last_error"]).empty()) text += "      " + Text(lcm["last_error"]) + "\n";
  }
  if (const json& flight = s["flight_record"]; !flight.is_null()) {
    if (!flight["file"].is_null()) text += "  flight record " + Text(flight["file"]) + "\n";
    if (!Text(flight["last_error"]).empty())
      text += "  flight record failed: " + Text(flight["last_error"]) + "\n";
  }
  if (const json& log = s["log"]; !log.is_null()) {
    text += "  log " + Text(log["file"]) + ": " + Text(log["cycles"]) + " cycles, lost " +
            Text(log["lost_cycles"]) + "\n";
    if (!Text(log["last_error"]).empty()) text += "      " + Text(log["last_error"]) + "\n";
  }
  return text;
}

std::string HaltSentence(const json& halt) {
  const bool waits = halt["for_operator"] == true;
  return std::string(waits ? ", holding" : ", switching") + " at line " + Text(halt["line"]) + ": " +
         Text(halt["word"]) + (waits ? " (contour resume goes on)" : "");
}

}  // namespace

std::string ProgramText(const json& s) {
  const json& program = s["program"];
  if (program["id"] == 0) return {};
  std::string text = "program " + Text(program["name"]);
  if (program.value("line", json()).is_number()) text += " line " + Text(program["line"]);
  const char* const about = program.value("duration_estimated", false) ? " of about " : " of ";
  text += ", " + Number(program["time_s"], 1.0, 1) + about + Number(program["duration_s"], 1.0, 1) + " s";
  if (program.value("left_s", json()).is_number())
    text += ", " + Number(program["left_s"], 1.0, 1) + " s left";
  if (program.value("feed_percent", 100.0) != 100.0)
    text += ", feed " + Number(program["feed_percent"], 1.0, 0) + " %";
  if (const json halt = program.value("halt", json()); halt.is_object())
    text += HaltSentence(halt);
  else if (program.value("pausing", false))
    text += program["paused"] == true ? ", paused" : ", pausing";
  if (s["state"] == "Running") text += ", contour error " + Number(s["contour_error_m"], 1e6, 2) + " um";
  return text;
}

std::string StatusText(const json& status) {
  return Machine(status) + Axes(status) + Errors(status) + Counters(status) + Buses(status) + Around(status);
}

std::string StatusLine(const json& status) {
  std::string line = StateSentence(status);
  for (const json& a : status["axes"])
    line += "  " + Text(a["name"]) + " " + Number(a["position_m"], 1e3, 4) + " mm " +
            Number(a["torque_Nm"], 1.0, 3) + " Nm " + Number(a["friction_N"], 1.0, 1) + " N";
  if (status["state"] == "Running") line += "  " + ProgramText(status);
  return line;
}

}  // namespace contour
