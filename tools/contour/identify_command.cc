#include "tools/contour/identify_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "analysis/axis_model/fitted_config.h"
#include "analysis/axis_model/read_stated_axis.h"
#include "analysis/parallel/parallel_for.h"
#include "analysis/recording/read_log.h"
#include "analysis/rough_fit/fit_numbers.h"
#include "analysis/rough_fit/position_jump.h"
#include "analysis/rough_fit/sound_logs.h"
#include "config/config_error.h"
#include "config/load_machine.h"
#include "config/whole_file.h"
#include "config/yaml_tree.h"
#include "tools/contour/identification_report.h"

namespace contour {
namespace {

struct Options {
  std::vector<std::string> logs;
  std::string model;
  std::string axis;
  std::string columns;
  std::string out;
  std::string report;
  int threads = 0;
  double resample_Hz = 0.0, sample_rate_Hz = 0.0;
};

diagnosis::ReadOptions ReadingOf(const Options& options, const std::string& axis,
                                 const diagnosis::StatedAxis& stated) {
  diagnosis::ReadOptions read;
  read.axis = axis;
  read.columns = diagnosis::ParseColumnNames(options.columns);
  read.table_per_q = stated.table_per_q;
  read.resample_Hz = options.resample_Hz;
  read.sample_rate_Hz = options.sample_rate_Hz;
  return read;
}

std::vector<diagnosis::AxisLog> LogsOf(const Options& options, const diagnosis::ReadOptions& read,
                                       bool linear) {
  std::vector<diagnosis::AxisLog> logs;
  for (const std::string& file : options.logs) {
    logs.push_back(diagnosis::ReadLog(file, read));
    if (logs.back().linear != linear)
      throw ConfigError({file + ": is the log of a " + (linear ? "rotary" : "linear") + " axis, " +
                         options.model + " states a " + (linear ? "linear" : "rotary") + " one"});
  }
  return logs;
}

/// An axis that is no ball screw of a machine file: its numbers, written as the model file that it came from.
int IdentifyAlone(const Options& options, const diagnosis::StatedAxis& stated) {
  YamlValue tree = ParseYamlFile(options.model);
  diagnosis::LooseAxisFile file = diagnosis::ReadLooseFile(tree);
  const YamlEntry* model = tree.Find("model");
  const auto units = diagnosis::UnitsOf(model != nullptr ? model->value : tree);
  std::vector<diagnosis::AxisLog> logs =
      LogsOf(options, ReadingOf(options, options.axis, stated), stated.linear);
  if (const std::string why = diagnosis::PositionJump(logs, stated); !why.empty())
    throw std::runtime_error("no model was written: " + why);
  const diagnosis::AxisLog log = diagnosis::JoinLogs(std::move(logs));
  const diagnosis::FittedNumbers found = diagnosis::FitNumbers(log, stated, ThreadsOf(options.threads));
  if (!found.unusable.empty()) throw std::runtime_error("no model was written: " + found.unusable);
  diagnosis::IntoConfig(found.axis, file);
  std::string text = "# Written by contour identify from " + log.source + "\n# and the model " +
                     options.model + ".\n# uncertainty: relative, one standard deviation.\n";
  for (const std::string& note : found.notes) text += "# Note: " + note + "\n";
  text += diagnosis::TextOf(file, units);
  WriteWholeFile(options.out, text);
  std::cout << text << "wrote " << options.out << "\n";
  if (!options.report.empty()) std::cout << "no report: it is for ball screws\n";
  return kExitDone;
}

/// A ball screw with all that a machine file states of it; else nothing.
std::optional<ModelConfig> ScrewModel(const std::string& file) {
  try {
    return LoadModel(file);
  } catch (const ConfigError&) {
    return std::nullopt;
  }
}

int RunIdentify(const Options& options) {
  IdentificationJob job;
  job.stated = diagnosis::ReadStatedAxis(options.model, options.axis);
  std::string axis = options.axis;
  if (diagnosis::IsMachineFile(options.model)) {
    const MachineConfig machine = LoadMachine(options.model);
    if (axis.empty()) axis = machine.axes.begin()->first;
    job.model = machine.axes.at(axis).model;
  } else if (const auto screw = ScrewModel(options.model)) {
    job.model = *screw;
  } else {
    return IdentifyAlone(options, job.stated);
  }
  job.logs = LogsOf(options, ReadingOf(options, axis, job.stated), false);
  job.sources = options.logs;
  job.out = options.out;
  job.report = options.report;
  job.threads = options.threads;
  job.for_screw = "contour commission records a chirp that shows it";
  const diagnosis::SoundLogs sound = diagnosis::MakeSound(job.logs, job.stated);
  if (!sound.unusable.empty()) throw std::runtime_error("no model was written: " + sound.unusable);
  identify::Identification found = IdentifyWithProgress(job);
  if (!sound.note.empty()) found.notes.insert(found.notes.begin(), sound.note);
  Report(job, found);
  return kExitDone;
}

}  // namespace

void AddIdentifyCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("identify", "Friction and mechanics of an axis from recorded motion");
  sub->add_option("logs", options->logs, "Logs of contourd, or tables (docs/diagnosis_files.md)")
      ->required()
      ->check(CLI::ExistingFile);
  sub->add_option("--model", options->model, "Machine file, or a model alone: what is believed so far")
      ->required()
      ->check(CLI::ExistingFile);
  sub->add_option("--axis", options->axis, "Which axis, where there are several");
  sub->add_option("--columns", options->columns, "Headers of a table: time_s=t_s,torque_Nm=tau,...");
  sub->add_option("--resample", options->resample_Hz,
                  "Hz: puts rows that come at uneven times on a grid of this rate")
      ->check(CLI::PositiveNumber);
  sub->add_option("--sample-rate", options->sample_rate_Hz, "Hz: of a table that has no times")
      ->check(CLI::PositiveNumber);
  sub->add_option("--out", options->out, "Model file to write")->required();
  sub->add_option("--report", options->report, "Directory for identification.json and pictures");
  sub->add_option("--threads", options->threads, "Cores to use; 0: all")->check(CLI::Range(0, 256));
  sub->callback([options, &action] { action = [options] { return RunIdentify(*options); }; });
}

}  // namespace contour
