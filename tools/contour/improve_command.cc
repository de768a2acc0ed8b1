#include "tools/contour/improve_command.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "analysis/diagnosis/diagnose.h"
#include "analysis/diagnosis/report/diagnosis_text.h"
#include "analysis/parallel/parallel_for.h"
#include "analysis/prediction_error/keep_memory.h"
#include "config/axis_block.h"
#include "config/config_error.h"
#include "config/whole_file.h"
#include "config/yaml_tree.h"
#include "config/yaml_writer.h"
#include "daemon/program/program.h"
#include "daemon/program_limits.h"
#include "design/commission_plan.h"
#include "tools/contour/commission_loop.h"
#include "tools/contour/daemon_link.h"
#include "tools/contour/daemon_machine.h"
#include "tools/contour/draw_pictures.h"
#include "tools/contour/stop_signals.h"
#include "tools/contour/terminal_progress.h"
#include "tools/improve/default_programs.h"
#include "tools/improve/improve_report.h"
#include "tools/improve/improve_sequence.h"

namespace contour {
namespace {

namespace fs = std::filesystem;
using improve::ProgramText;

struct Options {
  std::string axis;
  std::string socket;
  std::string program, check_program;
  std::optional<double> travel_mm, max_speed_mm_s, max_torque_Nm;
  double machine_minutes = 15.0;
  std::size_t passes = 3;
  double false_alarm_rate = diagnosis::DiagnoseOptions{}.false_alarm_rate;
  std::string out, loop, report, write, truth;
  int threads = 0;
  bool yes = false;
};

ProgramText FromFile(const std::string& file) {
  return {fs::path(file).filename().string(), ReadTextFile(file), FormatOf(file)};
}

CommissionLimits LimitsOf(const AxisConfig& axis, const Options& options) {
  CommissionLimits limits = improve::UsualLimits(axis);
  if (options.travel_mm) limits.travel_mm = *options.travel_mm;
  if (options.max_speed_mm_s) limits.max_speed_mm_s = *options.max_speed_mm_s;
  if (options.max_torque_Nm) limits.max_torque_Nm = *options.max_torque_Nm;
  return limits;
}

/// What must hold before anything moves; throws with what does not.
void CheckBeforehand(const MachineConfig& machine, const nlohmann::json& status, const Options& options) {
  if (!machine.axes.contains(options.axis))
    throw ConfigError({"--axis: the daemon's machine has no axis \"" + options.axis + "\""});
  if (machine.machine.controller != ControllerName::kFull)
    throw ConfigError({"the daemon runs the controller " + std::string(Name(machine.machine.controller)) +
                       ", expected full: the others do not use a model's extensions"});
  if (status.at("state") != "Idle")
    throw std::runtime_error("improving begins from Idle, but the machine is " + StateSentence(status));
}

improve::ImproveRequest RequestFor(const MachineConfig& machine, DaemonMachine& daemon,
                                   const Options& options) {
  const CommissionLimits limits = LimitsOf(machine.axes.at(options.axis), options);
  const PerAxis<double> position_m = daemon.Position_m();
  improve::ImproveRequest request;
  request.axis = options.axis;
  request.space = improve::SpaceFor(machine, options.axis, limits, position_m);
  request.limits = ProgramLimits(machine);
  request.passes = options.passes;
  request.machine_time_s = 60.0 * options.machine_minutes;
  const ProgramText path =
      options.program.empty() ? UsualPath(machine, request.space) : FromFile(options.program);
  const ProgramText check =
      options.check_program.empty() ? UsualCheck(machine, request.space) : FromFile(options.check_program);
  request.path = improve::Place(path, request.space, request.limits, position_m);
  request.check = improve::Place(check, request.space, request.limits, position_m);
  if (request.path.program.text == request.check.program.text)
    throw ConfigError(
        {"--check-program: is the path itself, expected another one: what a model was fitted on "
         "does not say whether it is better"});
  // Its motions are those of commissioning, about the middle of what is allowed.
  const std::size_t i = request.space.axis;
  const double middle_mm = 5e2 * (request.space.axes[i].low_m + request.space.axes[i].high_m);
  for (const CommissionMotion& m : PlanCommissioning(machine, options.axis, middle_mm, limits).motions)
    request.experiments.push_back({m.what, m.yaml, ProgramFormat::kYaml});
  for (const ProgramText& e : request.experiments)
    if (e.name.starts_with("chirp")) request.shaking.push_back(e);
  return request;
}

/// Drawings alone, and with the experiments, s.
void SayWhatIsPlanned(const improve::ImproveRequest& request) {
  const double pass_s = request.path.duration_s + request.check.duration_s;
  const double series_s = static_cast<double>(request.passes + 1) * pass_s;
  PerAxis<double> middle;
  for (const improve::AxisSpace& s : request.space.axes) middle.push_back(0.5 * (s.low_m + s.high_m));
  double experiments_s = 0.0;
  for (const ProgramText& e : request.experiments)
    experiments_s += improve::Place(e, request.space, request.limits, middle).duration_s;
  std::cout << improve::Describe(request.space) << "drawn: " << request.path.program.name << ", "
            << request.check.program.name << "; " << request.passes + 1
            << " passes of each, before and after\n"
            << "machine time: " << static_cast<int>(2.0 * series_s) << " s for the drawings, up to "
            << static_cast<int>(experiments_s) << " s for experiments where the path leaves something open, "
            << "at most " << static_cast<int>(request.machine_time_s) << " s in all\n";
}

void WriteResult(const improve::ImproveResult& result, const improve::ImproveRequest& request,
                 const improve::TruthFiles& truth, const Options& options) {
  const fs::path report = options.report.empty() ? options.axis + "_improve" : options.report;
  fs::create_directories(report);
  WriteWholeFile(report / "improve.json", improve::ImproveJson(result, request, truth));
  WriteWholeFile(report / "diagnosis.txt", diagnosis::DiagnosisText(result.diagnosed.back().found));
  const auto drawn = [&](const char* name, const std::vector<improve::Drawing>& drawings) {
    if (!drawings.empty())
      improve::WriteDrawing(report / (std::string(name) + ".csv"), drawings.back(), request.space.names);
  };
  drawn("path_before", result.before.path);
  drawn("check_before", result.before.check);
  const improve::Trial* best = result.chosen();
  if (best != nullptr) {
    drawn("path_after", best->drawn.path);
    drawn("check_after", best->drawn.check);
  }
  std::cout << improve::ImproveText(result, request);
  if (best != nullptr && result.judgement.keep) {
    const std::string out = options.out.empty() ? options.axis + "_model.yaml" : options.out;
    const std::string model = WriteYaml(best->model);
    WriteWholeFile(out, "# model of axis " + options.axis + " by contour improve\n" + model);
    std::cout << "model: " << out << "; contourd runs with it until it ends\n";
    if (!options.write.empty()) {
      WriteWholeFile(options.write,
                     WithAxisBlock(ReadTextFile(options.write), options.write, options.axis, "model", model));
      std::cout << "wrote axes." << options.axis << ".model of " << options.write << "\n";
    }
    FindLoopWhereItIsNoLongerGood(result.machine, options.axis, best->model,
                                  options.loop.empty() ? options.axis + "_loop.yaml" : options.loop);
  }
  DrawPictures("plot_improve.py", report);
  std::cout << "report: " << report.string() << "\n";
}

int RunImprove(const Options& options) {
  diagnosis::KeepMemory();
  DaemonMachine daemon({options.socket, options.axis, options.yes, &StopRequested()});
  const MachineConfig machine = daemon.Machine();
  CheckBeforehand(machine, daemon.StatusOnceStarted(), options);
  const improve::ImproveRequest request = RequestFor(machine, daemon, options);
  daemon.Watch(request.space);
  SayWhatIsPlanned(request);
  StopOnSignals();
  diagnosis::DiagnoseOptions how;
  how.false_alarm_rate = options.false_alarm_rate;
  how.threads = ThreadsOf(options.threads);
  const auto diagnose = [&](const diagnosis::AxisLog& log, const diagnosis::StatedAxis& stated) {
    TerminalProgress progress;
    how.progress = [&](std::string_view doing, double share) {
      if (StopRequested()) throw improve::Refused("interrupted");
      progress.Show(doing, share);
    };
    return diagnosis::Diagnose(log, stated, how);
  };
  const improve::ImproveResult result = improve::ImproveSequence(daemon, request, diagnose).Run();
  improve::TruthFiles truth;
  // The daemon numbers the files of its new beginnings, one for each model that was tried.
  if (!options.truth.empty())
    truth = {options.truth, options.truth + "." + std::to_string(result.best.value_or(0) + 1)};
  WriteResult(result, request, truth, options);
  return kExitDone;
}

void AddLimits(CLI::App& sub, Options& options) {
  sub.add_option(
      "--travel_mm", options.travel_mm,
      "Whole way (default: a tenth of the stroke, at most 20 mm; three turns of the motor at least)");
  sub.add_option("--max_speed_mm_s", options.max_speed_mm_s,
                 "Largest speed (default: 40 % of the axis's limit, at most 100 mm/s)");
  sub.add_option("--max_torque_Nm", options.max_torque_Nm,
                 "Torque at which it stops (default: 60 % of the axis's limit, or what its ramps may take)");
  sub.add_option("--max_minutes", options.machine_minutes, "Machine time at most (default: 15)")
      ->check(CLI::Range(0.1, 600.0));
}

}  // namespace

void AddImproveCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("improve",
                                     "Find what the model of an axis lacks on the running machine, extend "
                                     "it, and keep it if it draws better");
  sub->add_option("--axis", options->axis, "The axis")->required();
  AddSocketOption(*sub, options->socket);
  sub->add_option("--program", options->program, "Path that the model is fitted on (default: a circle)")
      ->check(CLI::ExistingFile);
  sub->add_option("--check-program", options->check_program,
                  "Path that decides whether it is kept (default: another circle)")
      ->check(CLI::ExistingFile);
  AddLimits(*sub, *options);
  sub->add_option("--passes", options->passes, "Passes of each program that count, after one to settle")
      ->check(CLI::Range(2, 20));
  sub->add_option("--false-alarm-rate", options->false_alarm_rate, "As of contour diagnose")
      ->check(CLI::Range(1e-4, 0.5));
  sub->add_option("--out", options->out, "Model file to write (default: NAME_model.yaml)");
  sub->add_option("--loop", options->loop,
                  "Loop to write where the axis's own is not for the kept model (default: NAME_loop.yaml)");
  sub->add_option("--write", options->write, "Machine file to write the model into as well, where it is kept")
      ->check(CLI::ExistingFile);
  sub->add_option("--report", options->report, "Directory of the report (default: NAME_improve)");
  sub->add_option("--threads", options->threads, "Cores to use; 0: all")->check(CLI::Range(0, 256));
  sub->add_option("--truth", options->truth,
                  "Truth file that an emulated machine's contourd is writing: told beside the rest");
  sub->add_flag("--yes", options->yes, "Grant enabling, moving and loading the model beforehand");
  sub->footer(
      "Every step asks first, and a no or an interrupt (Ctrl-C) takes the torque off, loads the old model "
      "again "
      "and ends with status 1.");
  sub->callback([options, &action] { action = [options] { return RunImprove(*options); }; });
}

}  // namespace contour
