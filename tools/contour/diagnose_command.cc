#include "tools/contour/diagnose_command.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "analysis/axis_model/read_stated_axis.h"
#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/extensions_of.h"
#include "analysis/diagnosis/diagnose.h"
#include "analysis/diagnosis/report/diagnosis_json.h"
#include "analysis/diagnosis/report/diagnosis_text.h"
#include "analysis/diagnosis/report/extended_file.h"
#include "analysis/diagnosis/report/report.h"
#include "analysis/parallel/parallel_for.h"
#include "analysis/prediction_error/keep_memory.h"
#include "analysis/recording/read_log.h"
#include "analysis/rough_fit/complete_from_log.h"
#include "analysis/rough_fit/position_jump.h"
#include "analysis/rough_fit/unrelated_force.h"
#include "analysis/rough_fit/wrong_units.h"
#include "config/config_error.h"
#include "config/key_hints.h"
#include "config/load_machine.h"
#include "config/number_text.h"
#include "config/whole_file.h"
#include "daemon/program/program.h"
#include "design/loop_choice.h"
#include "tools/contour/terminal_progress.h"
#include "tools/contour_gain/contour_gain.h"

namespace contour {
namespace {

using namespace diagnosis;  // NOLINT(google-build-using-namespace): this file is its command

struct Options {
  std::vector<std::string> logs;
  std::string model;
  std::string axis;
  std::string out;
  std::string json;
  std::string columns;
  std::string program;
  double false_alarm_rate = diagnosis::DiagnoseOptions{}.false_alarm_rate;
  int bootstrap_runs = 0;
  std::uint64_t seed = 1;
  int threads = 0;
  std::vector<std::string> set;
  int most_effects = diagnosis::DiagnoseOptions{}.most_effects;
  std::string exclude;
  double resample_Hz = 0.0, sample_rate_Hz = 0.0;
};

AxisLog ReadLogs(const Options& options, const StatedAxis& stated) {
  ReadOptions read;
  read.axis = options.axis;
  read.columns = ParseColumnNames(options.columns);
  read.table_per_q = stated.table_per_q;
  read.resample_Hz = options.resample_Hz;
  read.sample_rate_Hz = options.sample_rate_Hz;
  std::vector<AxisLog> logs;
  for (const std::string& file : options.logs) {
    logs.push_back(ReadLog(file, read));
    if (logs.back().linear != stated.linear)
      throw ConfigError({file + ": is the log of a " + (logs.back().linear ? "linear" : "rotary") +
                         " axis, " + options.model + " states a " + (stated.linear ? "linear" : "rotary") +
                         " one"});
  }
  if (const std::string why = PositionJump(logs, stated); !why.empty()) throw ConfigError({why});
  return JoinLogs(std::move(logs));
}

/// The extended model beside the report; its name, or nothing when there is none.
std::string WriteExtendedModel(const Options& options, const Diagnosis& found, const AxisLog& log) {
  const std::string text = ExtendedFile(options.model, options.axis, found, log);
  if (text.empty()) return "";
  const std::string file = (std::filesystem::path(options.out) / "extended_model.yaml").string();
  WriteWholeFile(file, text);
  return file;
}

/// What is simulated with the causes found.
struct PathToDraw {
  MachineConfig machine;
  std::string axis;
  Program program;
};

/// As it stands where there is none for an axis: a log says something of such an axis, too.
MachineConfig WithLoops(const Options& options) {
  const MachineConfig machine = LoadMachine(options.model, options.set);
  try {
    std::vector<std::string> set = options.set;
    for (const std::string& loop : LoopsThatAreMissing(machine, options.model)) set.push_back(loop);
    return LoadMachine(options.model, set);
  } catch (const ConfigError&) {
    return machine;
  }
}

/// Of a machine file, with loops for axes that it states none for; a model alone has no path to draw.
std::optional<PathToDraw> PathOf(const Options& options) {
  if (options.out.empty() || !IsMachineFile(options.model)) return {};
  PathToDraw path{WithLoops(options), options.axis, {}};
  if (path.axis.empty()) path.axis = path.machine.axes.begin()->first;
  path.program = options.program.empty() ? UsualCircle(path.machine) : LoadProgram(options.program);
  return path;
}

/// What was found stands where the simulated machine stops, too, or has no loop.
std::optional<ContourGain> Predict(const PathToDraw& path, const AxisLog& log, Diagnosis& found) {
  try {
    return PredictContourGain(path.machine, path.axis, found, TemperatureOf(log), path.program);
  } catch (const std::exception& e) {
    found.notes.push_back(std::string("The path was not simulated: ") + e.what());
    return {};
  }
}

std::string PredictionText(const ContourGain& gain) {
  return "On the path, by simulation of " + gain.program + ": largest contour error " +
         RoundedText(gain.before_um) + " um with the model as stated, " + RoundedText(gain.after_um) +
         " um with the extended one, " + RoundedText(100.0 * std::abs(gain.gain())) +
         (gain.gain() < 0.0 ? " % more.\n" : " % less.\n");
}

std::vector<std::string> KindsOf(const std::string& list) {
  std::vector<std::string> kinds;
  std::istringstream in(list);
  for (std::string kind; std::getline(in, kind, ',');) {
    const auto all = AllCauses();
    if (std::none_of(all.begin(), all.end(), [&](const auto* c) { return *c->name == kind; })) {
      std::vector<std::string> names;
      for (const auto* c : all) names.emplace_back(*c->name);
      const KeyHint hint = NearestKey(kind, names);
      throw ConfigError({"--exclude: found '" + kind + "', expected kinds of causes" +
                         (hint.key.empty() ? "" : "; did you mean " + hint.key + "?")});
    }
    kinds.push_back(kind);
  }
  return kinds;
}

DiagnoseOptions HowOf(const Options& options) {
  DiagnoseOptions how;
  how.false_alarm_rate = options.false_alarm_rate;
  how.bootstrap_runs = options.bootstrap_runs;
  how.seed = options.seed;
  how.threads = ThreadsOf(options.threads);
  how.most_effects = options.most_effects;
  how.exclude = KindsOf(options.exclude);
  return how;
}

int RunDiagnose(const Options& options) {
  KeepMemory();
  StatedAxis stated = ReadStatedAxis(options.model, options.axis, options.set);
  DiagnoseOptions how = HowOf(options);
  const std::optional<PathToDraw> path = PathOf(options);
  AxisLog log = ReadLogs(options, stated);
  const std::vector<std::string> assumed = CompleteFromLog(log, stated);
  if (const std::string why = WrongUnits(log, stated); !why.empty())
    throw ConfigError({log.source + ": " + why});
  if (const std::string why = UnrelatedForce(log, stated); !why.empty())
    throw ConfigError({log.source + ": " + why});
  Diagnosis found;
  std::optional<ContourGain> contour;
  {
    TerminalProgress progress;
    how.progress = [&](std::string_view doing, double share) { progress.Show(doing, share); };
    found = Diagnose(log, stated, how);
    found.notes.insert(found.notes.begin(), assumed.begin(), assumed.end());
    if (path) {
      progress.Show("simulating the path", 1.0);
      contour = Predict(*path, log, found);
    }
  }
  std::string extended;
  if (!options.out.empty()) {
    std::filesystem::create_directories(options.out);
    extended = WriteExtendedModel(options, found, log);
  }
  const std::string json = DiagnosisJson(found, extended, contour);
  std::cout << DiagnosisText(found);
  if (contour) std::cout << PredictionText(*contour);
  if (!extended.empty()) std::cout << "Model with what was found: " << extended << "\n";
  if (!options.json.empty()) WriteWholeFile(options.json, json);
  if (!options.out.empty()) {
    const std::filesystem::path out = options.out;
    WriteWholeFile(out / "diagnose.json", json);
    WriteReport(out, log, stated, found, extended, contour);
    std::cout << "Report: " << (out / "report.html").string() << "\n";
  }
  return kExitDone;
}

}  // namespace

void AddDiagnoseCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub =
      app.add_subcommand("diagnose", "What a simulation gets wrong about an axis, and why, from a log");
  sub->add_option("logs", options->logs, "Logs of contourd, or tables (CSV) with time, command and position")
      ->required()
      ->check(CLI::ExistingFile);
  sub->add_option("--model", options->model, "Machine file, or a model that stands alone (YAML)")
      ->required()
      ->check(CLI::ExistingFile);
  sub->add_option("--axis", options->axis, "Axis, where the files hold several");
  sub->add_option("--out", options->out,
                  "Directory for report, pictures, diagnose.json and the extended model");
  sub->add_option("--json", options->json, "File for the result as JSON");
  sub->add_option("--false-alarm-rate", options->false_alarm_rate,
                  "Share of the logs of a machine that is as stated in which something may be found")
      ->check(CLI::Range(1e-4, 0.5));
  sub->add_option("--columns", options->columns, "NAME=HEADER,...: how a table spells what is needed");
  sub->add_option("--resample", options->resample_Hz,
                  "Hz: puts rows that come at uneven times on a grid of this rate")
      ->check(CLI::PositiveNumber);
  sub->add_option("--sample-rate", options->sample_rate_Hz, "Hz: of a table that has no times")
      ->check(CLI::PositiveNumber);
  sub->add_option("--most-effects", options->most_effects, "Causes that are named at most")
      ->check(CLI::Range(1, 20));
  sub->add_option("--exclude", options->exclude, "KIND,...: causes that are not looked for");
  sub->add_option("--program", options->program,
                  "Program whose contour error is simulated for the report; default: a circle of 10 mm")
      ->check(CLI::ExistingFile);
  sub->add_option("--bootstrap", options->bootstrap_runs,
                  "Refits with every stroke at random, for the intervals; 0: none, else 50 or more")
      ->check(CLI::Range(0, 0) | CLI::Range(50, 100000));
  sub->add_option("--seed", options->seed, "Of everything drawn; the same seed gives the same answer")
      ->check(CLI::NonNegativeNumber);
  sub->add_option("--threads", options->threads, "Cores to use; 0: all")->check(CLI::Range(0, 256));
  sub->add_option("--set", options->set, "KEY=VALUE: override a key of the model file; repeatable")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  sub->callback([options, &action] { action = [options] { return RunDiagnose(*options); }; });
}

}  // namespace contour
