#include "tools/contour/identify_command.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "analysis/axis_model/read_stated_axis.h"
#include "analysis/recording/read_log.h"
#include "config/config_error.h"
#include "config/load_machine.h"
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
};

int RunIdentify(const Options& options) {
  IdentificationJob job;
  job.stated = diagnosis::ReadStatedAxis(options.model, options.axis);
  if (job.stated.linear)
    throw ConfigError(
        {options.model +
         ": states a linear axis (mass_kg); identify takes axes with a motor that turns, \"contour "
         "diagnose\" takes both"});
  std::string axis = options.axis;
  if (diagnosis::IsMachineFile(options.model)) {
    const MachineConfig machine = LoadMachine(options.model);
    if (axis.empty()) axis = machine.axes.begin()->first;
    job.model = machine.axes.at(axis).model;
  } else {
    job.model = LoadModel(options.model);
  }
  diagnosis::ReadOptions read;
  read.axis = axis;
  read.columns = diagnosis::ParseColumnNames(options.columns);
  read.table_per_q = job.stated.table_per_q;
  for (const std::string& log : options.logs) job.logs.push_back(diagnosis::ReadLog(log, read));
  job.sources = options.logs;
  job.out = options.out;
  job.report = options.report;
  job.threads = options.threads;
  IdentifyAndReport(job);
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
  sub->add_option("--out", options->out, "Model file to write")->required();
  sub->add_option("--report", options->report, "Directory for identification.json and pictures");
  sub->add_option("--threads", options->threads, "Cores to use; 0: all")->check(CLI::Range(0, 256));
  sub->callback([options, &action] { action = [options] { return RunIdentify(*options); }; });
}

}  // namespace contour
