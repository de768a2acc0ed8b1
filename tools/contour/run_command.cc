#include "tools/contour/run_command.h"
#include "tools/contour/program_warnings.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "daemon/control_socket/base64.h"
#include "daemon/program/placed_program.h"
#include "daemon/program/program.h"
#include "tools/contour/choice_flag.h"
#include "tools/contour/daemon_link.h"
#include "tools/contour/result_line.h"
#include "tools/contour/run_record.h"
#include "tools/contour/status_text.h"
#include "tools/contour/stop_signals.h"

namespace contour {
namespace {

using nlohmann::json;

struct Options {
  std::string program;
  std::string socket;
  std::optional<std::string> out;
  std::optional<std::string> truth;
  std::string controller;
  bool forget = false;
  bool from_here = false;
  PartOfProgram part;
};

constexpr std::chrono::milliseconds kLookEvery{100};
/// How long to wait for rows that are on their way when the program is over.
constexpr std::chrono::seconds kLastRows{5};

/// Rows on their way from the daemon into a RunRecord.
class RowCollector {
 public:
  RowCollector(ControlClient& client, const std::filesystem::path& directory)
      : client_(client), record_(directory) {
    client_.OnMessage([this](const json& message) { OnMessage(message); });
    AskOrThrow(client_, {{"request", "rows"}, {"on", true}});
  }

  void SetProgram(std::uint32_t id) {
    program_id_ = id;
    for (const std::string& row : early_) Add(row);
    early_.clear();
  }

  /// Waits until the row of this cycle is here.
  void Await(std::uint64_t cycle) {
    const auto deadline = std::chrono::steady_clock::now() + kLastRows;
    while (failure_.empty() && record_.newest_cycle() < cycle && std::chrono::steady_clock::now() < deadline)
      client_.Listen(kLookEvery);
  }

  RunRecord& record() { return record_; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  /// Why rows could not be kept; empty while they could.
  [[nodiscard]] const std::string& failure() const { return failure_; }

 private:
  /// A full disk must not end the client while the machine moves: it follows the program, without rows.
  void Add(const std::string& row) {
    if (!failure_.empty()) return;
    try {
      record_.Add(row, *program_id_);
    } catch (const std::exception& e) {
      failure_ = e.what();
      std::cerr << "contour: " << failure_
                << "; the program goes on without rows, metrics and table. An interrupt stops the machine\n";
    }
  }

  void OnMessage(const json& message) {
    if (!message.contains("rows")) return;
    lost_ = message.at("lost");
    for (const json& text : message.at("rows")) {
      auto row = FromBase64(text.get<std::string>());
      if (!row) throw ConnectionLost("contourd sends rows that are not base64");
      if (program_id_) {
        Add(*row);
      } else {
        early_.push_back(std::move(*row));
      }
    }
  }

  ControlClient& client_;
  RunRecord record_;
  std::optional<std::uint32_t> program_id_;
  std::vector<std::string> early_;  ///< rows that came before the program had a number
  std::uint64_t lost_ = 0;
  std::string failure_;
};

/// Over when the machine holds again, with a reason, or has left the states in which a program can run.
bool Ended(const json& status, std::uint32_t program_id) {
  if (status.at("program").at("id") != program_id) return true;
  const std::string state = status.at("state");
  if (state == "Ready") return status.at("reason") != "none";
  return state != "Running" && state != "Stopping";
}

class ProgressLine {
 public:
  void Show(const json& status) {
    if (!terminal_) return;
    std::fprintf(stderr, "\r\x1b[K%s  %s", status.at("state").get<std::string>().c_str(),
                 ProgramText(status).c_str());
  }
  ~ProgressLine() {
    if (terminal_) std::fputs("\r\x1b[K", stderr);
  }

 private:
  bool terminal_ = ::isatty(STDERR_FILENO) != 0;
};

json Follow(ControlClient& client, std::uint32_t program_id) {
  ProgressLine progress;
  bool asked_to_stop = false;
  for (;;) {
    json status = Status(client);
    if (Ended(status, program_id)) return status;
    progress.Show(status);
    if (StopRequested() && !asked_to_stop) {
      asked_to_stop = true;
      client.Ask({{"request", "stop"}});
    }
    const auto until = std::chrono::steady_clock::now() + kLookEvery;
    // A message may come at once; listening goes on until it is time to look again.
    while (std::chrono::steady_clock::now() < until && !StopRequested())
      client.Listen(std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now()));
    if (StopRequested()) client.Listen(std::chrono::milliseconds(20));
  }
}

Placement PlaceOf(const json& reply) {
  Placement place;
  for (const json& value : reply.at("start_m")) place.start_m.push_back(value.get<double>());
  for (const json& value : reply.at("zero_m")) place.zero_m.push_back(value.get<double>());
  return place;
}

/// Where the program is drawn, if that is news.
void TellPlace(const json& reply, const Program& program) {
  char text[160];
  const double off_mm = 1e3 * PlaceOf(reply).Off_m();
  if (reply.at("zero_set") == true) {
    std::cout << "program zero is where the machine stands; it stays there until contour zero\n";
  } else if (off_mm > 1e-6 && !std::holds_alternative<GcodeMoves>(program.shape)) {
    std::snprintf(text, sizeof text, "the machine stands %.4f mm from program zero and goes there first\n",
                  off_mm);
    std::cout << text;
  }
  std::cout << std::flush;
}

PerAxis<PlanLimits> LimitsOf(const json& status) {
  PerAxis<PlanLimits> limits;
  for (const json& axis : status.at("axes")) {
    const json& f = axis.at("facts");
    limits.push_back({axis.at("name"), f.at("position_min_m"), f.at("position_max_m"), f.at("velocity_m_s"),
                      f.at("acceleration_m_s2"), f.at("jerk_m_s3")});
  }
  return limits;
}

RunRecord::Facts FactsOf(const json& status, const std::string& program) {
  RunRecord::Facts facts;
  facts.controller = status.at("controller");
  facts.program = program;
  facts.cycle_us = status.at("cycle_us");
  facts.wall_clock = status.at("clock") == "wall";
  if (status.at("emulator_seed").is_number()) facts.seed = status.at("emulator_seed").get<std::uint64_t>();
  for (const json& axis : status.at("axes"))
    facts.axes.push_back({axis.at("name"), axis.at("facts").at("encoder_count_m")});
  return facts;
}

/// What the daemon saw of the program; of the rows, where there are some, what was scored.
ProgramResult ResultOf(const json& status, const std::string& name) {
  const json& program = status.at("program");
  ProgramResult result;
  result.program = std::filesystem::path(name).filename().string();
  result.seconds = program.at("ran_s");
  const auto um = [&](const char* key) {
    return program.at(key).is_number() ? std::optional(1e6 * program.at(key).get<double>()) : std::nullopt;
  };
  result.encoder_peak_um = um("contour_error_peak_m");
  result.encoder_rms_um = um("contour_error_rms_m");
  result.faults = status.at("state") == "Faulted" ? 1 : 0;
  if (status.at("log").is_object()) result.log = status.at("log").at("file");
  return result;
}

/// What the log has lost since `before`, and why; empty: nothing.
std::string LostByLog(const json& before, const json& after) {
  if (!after.at("log").is_object()) return {};
  const auto lost = [](const json& status, const char* what) {
    return status.at("log").is_object() ? status.at("log").at(what).get<std::uint64_t>() : std::uint64_t{0};
  };
  // A daemon that has begun anew since writes another log.
  const bool same = before.at("log").is_object() && before.at("log").at("file") == after.at("log").at("file");
  const auto since = [&](const char* what) { return lost(after, what) - (same ? lost(before, what) : 0); };
  const std::uint64_t cycles = since("lost_cycles"), notes = since("lost_notes");
  if (cycles == 0 && notes == 0) return {};
  const std::string why = after.at("log").at("last_error");
  return std::to_string(cycles) + " cycles and " + std::to_string(notes) + " notes" +
         (why.empty() ? std::string() : ": " + why);
}

void Put(const RunMetrics& metrics, ProgramResult& result) {
  if (metrics.encoder.peak_um) {
    result.encoder_peak_um = metrics.encoder.peak_um;
    result.encoder_rms_um = metrics.encoder.rms_um;
  }
  result.table_peak_um = metrics.table.peak_um;
}

std::string EndSentence(const json& status, std::uint32_t program_id) {
  if (status.at("program").at("id") != program_id) return "another program has been started since";
  return StateSentence(status);
}

/// Where the program will be placed, as far as the status tells before it is.
Placement PlaceBefore(const json& status, bool here) {
  Placement place;
  const json& zero_mm = status.at("zero_mm");
  for (const json& axis : status.at("axes")) {
    const double at_m =
        axis.at("reference_position_m").is_number() ? axis.at("reference_position_m").get<double>() : 0.0;
    place.start_m.push_back(at_m);
    place.zero_m.push_back(here || zero_mm.is_null() ? at_m
                                                     : 1e-3 * zero_mm.at(axis.at("name")).get<double>());
  }
  return place;
}

PartOfProgram PartFor(const Options& options, const json& status) {
  const json& defaults = status.at("program_defaults");
  PartOfProgram part = options.part;
  if (!part.optional_stop) part.optional_stop = defaults.at("optional_stop").get<bool>();
  if (!part.block_delete) part.block_delete = defaults.at("block_delete").get<bool>();
  part.tool_table = defaults.at("tool_table").get<std::string>();
  return part;
}

/// What the daemon does about the program's events.
EventUse EventsFor(const Options& options, const json& status) {
  const auto outputs = status.at("program_defaults").at("outputs").get<std::vector<std::string>>();
  EventUse use;
  use.optional_stop = *PartFor(options, status).optional_stop;
  use.switches = [outputs](const GcodeEvent& event) {
    return std::find(outputs.begin(), outputs.end(), NameOf(event)) != outputs.end();
  };
  return use;
}

/// The program as the daemon reads it for that place.
Program ReadFor(const Placement& place, const json& status, const Options& options) {
  const std::string& file = options.program;
  const std::string text = ReadProgramText(file);
  bool referenced = true;
  for (const json& axis : status.at("axes")) referenced = referenced && axis.value("referenced", true);
  return ReadPlaced({text, file, FormatOf(file)}, place, LimitsOf(status),
                    {referenced, PartFor(options, status), EventsFor(options, status)});
}

json RequestOf(const Options& options) {
  const bool gcode = FormatOf(options.program) == ProgramFormat::kGcode;
  json request{{"request", "run"},
               {"name", std::filesystem::path(options.program).filename().string()},
               {"format", gcode ? "ngc" : "yaml"},
               {"text", ReadProgramText(options.program)}};
  if (!options.controller.empty()) request["controller"] = options.controller;
  if (options.forget) request["forget"] = true;
  if (options.from_here) request["from_here"] = true;
  if (options.part.single_block) request["single_block"] = true;
  if (options.part.optional_stop) request["optional_stop"] = *options.part.optional_stop;
  if (options.part.block_delete) request["block_delete"] = *options.part.block_delete;
  if (options.part.from_line > 0) request["from_line"] = options.part.from_line;
  if (options.part.go_there) request["go_there"] = true;
  return request;
}

/// Writes what was collected, and puts what was scored into the result.
void WriteRows(RowCollector& rows, const Options& options, const json& status, const Placement& place,
               ProgramResult& result) {
  if (rows.record().cycles() == 0) return;
  std::optional<std::filesystem::path> truth;
  if (options.truth) truth = *options.truth;
  const Program program = ReadFor(place, status, options);
  Put(rows.record().Write(FactsOf(status, program.name), PlanPlaced(program, place, LimitsOf(status)), truth),
      result);
  std::cout << "wrote " << *options.out << "/metrics.json and cycles.csv, " << rows.record().cycles()
            << " cycles";
  if (rows.lost() > 0) std::cout << "; " << rows.lost() << " LOST on the way: this computer is too slow";
  std::cout << "\n";
}

int RunRun(const Options& options) {
  Program program;
  std::optional<ControlClient> client;
  json before;
  try {
    // What G-code means depends on where the machine stands.
    if (FormatOf(options.program) == ProgramFormat::kYaml)
      program = ReadPlaced({ReadProgramText(options.program), options.program, ProgramFormat::kYaml}, {}, {},
                           {false, options.part, {}});
    client.emplace(ConnectToDaemon(options.socket));
    before = Status(*client);
    if (FormatOf(options.program) == ProgramFormat::kGcode)
      program = ReadFor(PlaceBefore(before, options.from_here), before, options);
  } catch (const ProgramError& e) {
    std::cerr << e.what() << "\n";
    return kExitBadUsage;
  }
  double following_m = 0.0;
  for (const json& axis : before.at("axes"))
    following_m = std::max(following_m, axis.at("facts").at("path_following_m").get<double>());
  WarnOfProgram(options.program, EventsFor(options, before), PartFor(options, before), false, following_m);
  StopOnSignals();
  std::optional<RowCollector> rows;
  if (options.out) rows.emplace(*client, *options.out);
  const json reply = RunProgram(*client, RequestOf(options));
  const std::uint32_t id = reply.at("program_id");
  TellPlace(reply, program);
  if (reply.contains("text")) std::cout << reply.at("text").get<std::string>() << "\n" << std::flush;
  if (const std::size_t passes = reply.value("learnt_passes", std::size_t{0}); passes > 0)
    std::cout << "passes learnt from: " << passes << "\n" << std::flush;
  if (rows) rows->SetProgram(id);
  const json after = Follow(*client, id);
  if (rows) rows->Await(after.at("cycle"));
  const bool ours = after.at("program").at("id") == id;
  ProgramResult result = ours ? ResultOf(after, program.name) : ProgramResult{};
  const std::string failure = rows ? rows->failure() : std::string();
  if (rows && failure.empty()) WriteRows(*rows, options, before, PlaceOf(reply), result);
  const std::string unlogged = ours ? LostByLog(before, after) : std::string();
  if (!unlogged.empty()) result.log += ", which LOST " + unlogged;
  if (ours) std::cout << ResultLine(result) << "\n" << std::flush;
  const bool done = after.at("reason") == "program_end" && ours;
  if (!done) throw std::runtime_error("the program did not end by itself: " + EndSentence(after, id));
  std::cout << "done: " << program.name << "\n";
  if (!failure.empty()) throw std::runtime_error("the program has ended, but its rows are lost: " + failure);
  if (!unlogged.empty())
    throw std::runtime_error(
        "the program has ended, but it is not in the log as a whole and cannot be replayed");
  return kExitDone;
}

}  // namespace

void AddRunCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("run", "Run a program on a running contourd and wait for its end");
  sub->add_option("program", options->program, "Program: YAML or G-code (.ngc)")->required();
  AddSocketOption(*sub, options->socket);
  CLI::Option* out = sub->add_option("--out", options->out, "Directory for metrics.json and cycles.csv");
  sub->add_option("--truth", options->truth, "Truth file that contour emulate is writing")
      ->needs(out)
      ->check(CLI::ExistingFile);
  sub->add_option("--controller", options->controller,
                  "Refuse to run unless the daemon runs with this controller");
  sub->add_flag("--forget", options->forget, "Forget first what has been learnt of programs");
  sub->add_flag("--from-here", options->from_here,
                "The program counts from where the machine stands, whatever program zero is");
  sub->add_flag("--single-block", options->part.single_block,
                "G-code: rest at the end of every line until contour resume");
  AddChoice(*sub, "--optional-stop,!--no-optional-stop", options->part.optional_stop,
            "G-code: M1 waits for contour resume, as M0 does, or not; default machine.optional_stop");
  AddChoice(*sub, "--block-delete,!--no-block-delete", options->part.block_delete,
            "G-code: leave lines out that begin with a slash, or not; default machine.block_delete");
  CLI::Option* line = sub->add_option("--from-line", options->part.from_line,
                                      "G-code: begin at this line, with the words in force there")
                          ->check(CLI::Range(1, 100'000'000));
  sub->add_flag("--go-there", options->part.go_there,
                "Go at rapid to where that line begins; otherwise the machine must stand there")
      ->needs(line);
  sub->footer("An interrupt (Ctrl-C) stops the machine on the path and ends this program with status 1.");
  sub->callback([options, &action] { action = [options] { return RunRun(*options); }; });
}

}  // namespace contour
