#include "tools/contour/simulate_command.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "config/load_machine.h"
#include "config/number_text.h"
#include "core/exit_status.h"
#include "daemon/make_log_header.h"
#include "daemon/output_words.h"
#include "daemon/program/path_walk.h"
#include "daemon/program/program.h"
#include "design/loop_judgement.h"
#include "design/path_following.h"
#include "tools/contour/choice_flag.h"
#include "tools/contour/program_warnings.h"
#include "tools/contour/result_line.h"
#include "tools/machine/load_emulated_machine.h"
#include "tools/simulate/simulation_run.h"

namespace contour {
namespace {

struct Options {
  std::string config;
  std::string program;
  std::string controller;
  std::vector<std::string> set;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> feed;
  std::vector<FeedFrom> feeds;
  int passes = 1;
  std::string out;
  std::string log;
  PartOfProgram part;
};

std::string Line(const SimulationResult& result, const SimulationRequest& request) {
  const ContourMetrics& encoder = result.metrics.encoder;
  ProgramResult line;
  line.program = std::filesystem::path(request.program.name).filename().string();
  line.seconds = static_cast<double>(result.tally.cycles) * request.file.machine.machine.cycle_us * 1e-6;
  // What ends before it would be scored is told as the cycle saw it.
  line.encoder_peak_um = encoder.peak_um.value_or(1e6 * result.tally.contour_error_peak_m);
  line.encoder_rms_um = encoder.rms_um.value_or(1e6 * result.tally.contour_error_rms_m);
  line.table_peak_um = result.metrics.table.peak_um;
  line.log = request.log.string();
  return ResultLine(line);
}

constexpr double kLargestFeed_percent = 100.0 * PathWalk::kLargestScale;

/// PERCENT or PERCENT@SECONDS.
FeedFrom FeedOf(const std::string& text) {
  double percent = 0.0, time_s = 0.0;
  char at = '@';
  std::istringstream stream(text);
  stream >> percent;
  if (stream && !stream.eof()) stream >> at >> time_s;
  std::string rest;
  if (!stream || at != '@' || stream >> rest || !(percent >= 0.0 && percent <= kLargestFeed_percent) ||
      !(time_s >= 0.0))
    throw CLI::ValidationError("--feed", "found '" + text + "', expected PERCENT or PERCENT@SECONDS, 0 to " +
                                             RoundedText(kLargestFeed_percent) + " percent");
  return {time_s, 0.01 * percent};
}

std::vector<FeedFrom> FeedsOf(const std::vector<std::string>& texts) {
  std::vector<FeedFrom> feeds;
  for (const std::string& text : texts) feeds.push_back(FeedOf(text));
  std::stable_sort(feeds.begin(), feeds.end(),
                   [](const FeedFrom& a, const FeedFrom& b) { return a.time_s < b.time_s; });
  if (!feeds.empty() && feeds.back().feed == 0.0)
    throw CLI::ValidationError("--feed", "the last feed is 0: the program would never end");
  return feeds;
}

/// A simulation hurts nobody, and what a limit is worth may be what it is for; but what an unstable loop does
/// there says nothing of the machine.
void RequireStableLoops(MachineConfig machine, ControllerName controller, const Options& options) {
  machine.machine.controller = controller;
  const LoopVerdicts verdicts = JudgeStatedLoops(machine, LoopDemand::kStability);
  if (!verdicts.refused.empty())
    throw ConfigError(WithPlaces(OpenMachineFile(options.config, options.set), verdicts.refused));
  for (const std::string& warned : verdicts.warned) std::cerr << "warning: " << warned << "\n";
}

int RunSimulate(const Options& options) {
  SimulationRequest request;
  request.feeds = options.feeds;
  std::vector<std::string> set = options.set;
  // The file's own controller judges what the file allows: in a simulation a softer rival hurts nobody. But
  // `full` may need loops that the file has no use for.
  if (options.controller == Name(ControllerName::kFull)) set.push_back("machine.controller=full");
  std::optional<ControllerName> runs;
  if (!options.controller.empty() && !FromName(options.controller, runs.emplace())) {
    std::cerr << "contour: --controller: found '" << options.controller << "', expected "
              << Choices(ControllerName{}) << "\n";
    return kExitBadUsage;
  }
  request.file = LoadEmulatedMachine(options.config, set, runs);
  if (options.seed) request.file.emulator.seed = *options.seed;
  request.controller = runs.value_or(request.file.machine.machine.controller);
  RequireStableLoops(request.file.machine, request.controller, options);
  try {
    if (FormatOf(options.program) == ProgramFormat::kGcode) {
      request.program.name = options.program;
      request.gcode = ReadProgramText(options.program);
    } else {
      request.program = LoadProgram(options.program);
    }
  } catch (const ProgramError& e) {
    std::cerr << e.what() << "\n";
    return kExitBadUsage;
  }
  request.passes = options.passes;
  const MachineConfig& said = request.file.machine;
  request.part = options.part;
  request.part.block_delete = options.part.block_delete.value_or(said.machine.block_delete);
  request.part.tool_table = said.machine.tool_table;
  WarnOfProgram(options.program,
                UseOfEvents(said, options.part.optional_stop.value_or(said.machine.optional_stop)),
                request.part, true, 1e-3 * said.machine.path_following_mm.value_or(0.0));
  if (const std::optional<std::string> wider = WiderToleranceText(said); wider && request.gcode)
    std::cerr << "contour: " << *wider << "\n";
  request.out = options.out;
  if (!options.log.empty()) {
    if (options.seed) set.push_back("emulator.seed=" + std::to_string(*options.seed));
    set.push_back("machine.controller=" + std::string(Name(request.controller)));
    request.log = options.log;
    MachineConfig machine = request.file.machine;
    machine.machine.controller = request.controller;
    request.log_header = MakeLogHeader(ReadSource(options.config, set), machine, "virtual", 0);
  }
  const SimulationResult result = RunSimulation(request);
  std::cout << Line(result, request) << "\n";
  std::cout << "wrote " << (std::filesystem::path(options.out) / "metrics.json").string()
            << (options.passes > 1 ? ", cycles.csv and passes.csv\n" : " and cycles.csv\n");
  return kExitDone;
}

}  // namespace

void AddSimulateCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub =
      app.add_subcommand("simulate", "Run the daemon's cycle on the emulated machine in virtual time");
  sub->add_option("--config", options->config, "Machine file with an emulator: section")->required();
  sub->add_option("--program", options->program, "Program: YAML or G-code (.ngc)")->required();
  sub->add_option("--controller", options->controller, "Controller instead of the machine file's");
  sub->add_option("--set", options->set, "KEY=VALUE: override a key of the machine file; repeatable")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  sub->add_option("--seed", options->seed, "Seed of the emulated machine")->check(CLI::NonNegativeNumber);
  sub->add_option("--passes", options->passes,
                  "Run the program so many times, one after the other; metrics and cycles are of the last")
      ->check(CLI::Range(1, 10000));
  sub->add_option("--feed", options->feed,
                  "PERCENT or PERCENT@SECONDS: run at so many percent of the programmed feed, 0 to 200, from "
                  "the beginning or so long after it; repeatable. Only G-code can be faster than programmed")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  AddChoice(*sub, "--block-delete,!--no-block-delete", options->part.block_delete,
            "G-code: leave lines out that begin with a slash, or not; default machine.block_delete");
  sub->add_option("--out", options->out, "Directory for metrics.json and cycles.csv")->required();
  sub->add_option("--log", options->log, "Record every cycle in this log, for `contour replay`");
  sub->callback([options, &action] {
    options->feeds = FeedsOf(options->feed);
    action = [options] { return RunSimulate(*options); };
  });
}

}  // namespace contour
