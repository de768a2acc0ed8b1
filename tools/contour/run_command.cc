#include "tools/contour/run_command.h"
#include "tools/contour/ignored_words.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
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
#include "daemon/program/program.h"
#include "tools/contour/daemon_link.h"
#include "tools/contour/run_record.h"

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
};

constexpr std::chrono::milliseconds kLookEvery{100};
/// How long to wait for rows that are on their way when the program is over.
constexpr std::chrono::seconds kLastRows{5};

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

void OnSignal(int /*signal*/) { stop_requested.store(true); }

std::string ReadText(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (in.bad()) throw std::runtime_error("cannot read " + file);
  return text;
}

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
    for (const std::string& row : early_) record_.Add(row, id);
    early_.clear();
  }

  /// Waits until the row of this cycle is here.
  void Await(std::uint64_t cycle) {
    const auto deadline = std::chrono::steady_clock::now() + kLastRows;
    while (record_.newest_cycle() < cycle && std::chrono::steady_clock::now() < deadline)
      client_.Listen(kLookEvery);
  }

  RunRecord& record() { return record_; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  void OnMessage(const json& message) {
    if (!message.contains("rows")) return;
    lost_ = message.at("lost");
    for (const json& text : message.at("rows")) {
      auto row = FromBase64(text.get<std::string>());
      if (!row) throw ConnectionLost("contourd sends rows that are not base64");
      if (program_id_) {
        record_.Add(*row, *program_id_);
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
    const json& program = status.at("program");
    std::fprintf(
        stderr, "\r\x1b[K%s  %.1f of %.1f s  contour error %.2f um",
        status.at("state").get<std::string>().c_str(),
        program.at("time_s").is_number() ? program.at("time_s").get<double>() : 0.0,
        program.at("duration_s").is_number() ? program.at("duration_s").get<double>() : 0.0,
        status.at("contour_error_m").is_number() ? status.at("contour_error_m").get<double>() * 1e6 : 0.0);
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
    if (stop_requested && !asked_to_stop) {
      asked_to_stop = true;
      client.Ask({{"request", "stop"}});
    }
    const auto until = std::chrono::steady_clock::now() + kLookEvery;
    // A message may come at once; listening goes on until it is time to look again.
    while (std::chrono::steady_clock::now() < until && !stop_requested)
      client.Listen(std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now()));
    if (stop_requested) client.Listen(std::chrono::milliseconds(20));
  }
}

PerAxis<double> StartOf(const json& reply) {
  PerAxis<double> start_m;
  for (const json& value : reply.at("start_m")) start_m.push_back(value.get<double>());
  return start_m;
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

std::string EndSentence(const json& status, std::uint32_t program_id) {
  if (status.at("program").at("id") != program_id) return "another program has been started since";
  return StateSentence(status);
}

int RunRun(const Options& options) {
  Program program;
  try {
    program = LoadProgram(options.program);
  } catch (const ProgramError& e) {
    std::cerr << e.what() << "\n";
    return kExitBadUsage;
  }
  WarnOfIgnoredWords(options.program);
  std::signal(SIGINT, OnSignal);
  std::signal(SIGTERM, OnSignal);
  ControlClient client = ConnectToDaemon(options.socket);
  const json before = Status(client);
  std::optional<RowCollector> rows;
  if (options.out) rows.emplace(client, *options.out);
  const bool gcode = FormatOf(options.program) == ProgramFormat::kGcode;
  json request{{"request", "run"},
               {"name", std::filesystem::path(options.program).filename().string()},
               {"format", gcode ? "ngc" : "yaml"},
               {"text", ReadText(options.program)}};
  if (!options.controller.empty()) request["controller"] = options.controller;
  if (options.forget) request["forget"] = true;
  const json reply = RunProgram(client, std::move(request));
  const std::uint32_t id = reply.at("program_id");
  if (const std::size_t passes = reply.value("learnt_passes", std::size_t{0}); passes > 0)
    std::cout << "passes learnt from: " << passes << "\n" << std::flush;
  if (rows) rows->SetProgram(id);
  const json after = Follow(client, id);
  if (rows) rows->Await(after.at("cycle"));
  if (rows && rows->record().cycles() > 0) {
    std::optional<std::filesystem::path> truth;
    if (options.truth) truth = *options.truth;
    rows->record().Write(FactsOf(after, program.name), PlanMotion(program, StartOf(reply), LimitsOf(before)),
                         truth);
    std::cout << "wrote " << *options.out << "/metrics.json and cycles.csv, " << rows->record().cycles()
              << " cycles";
    if (rows->lost() > 0) std::cout << "; " << rows->lost() << " LOST on the way: this computer is too slow";
    std::cout << "\n";
  }
  const bool done = after.at("reason") == "program_end" && after.at("program").at("id") == id;
  if (!done) throw std::runtime_error("the program did not end by itself: " + EndSentence(after, id));
  std::cout << "done: " << program.name << "\n";
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
  sub->footer("An interrupt (Ctrl-C) stops the machine on the path and ends this program with status 1.");
  sub->callback([options, &action] { action = [options] { return RunRun(*options); }; });
}

}  // namespace contour
