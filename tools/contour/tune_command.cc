#include "tools/contour/tune_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "analysis/parallel/parallel_for.h"
#include "config/config_error.h"
#include "config/whole_file.h"
#include "core/exit_status.h"
#include "tools/contour/tune_loops.h"
#include "tools/validation/contest/contest_plan.h"
#include "tools/validation/contest/tuning.h"

namespace contour {
namespace {

struct Options {
  std::string config = "config/xy_emulated.yaml";
  std::string contest = "config/contest.yaml";
  std::vector<std::string> controllers;
  int evaluations = 0;
  unsigned workers = 0;
  std::string out;
  std::string from_model;
  std::string axis;
  bool catalogue = false;
};

std::vector<TunedController> Chosen(const TuneConfig& config, const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (std::none_of(config.controllers.begin(), config.controllers.end(),
                     [&](const TunedController& c) { return c.name == name; }))
      throw ConfigError({"contour: --controllers: nothing to tune is listed for '" + name + "'"});
  std::vector<TunedController> chosen;
  for (const TunedController& c : config.controllers)
    if (names.empty() || std::find(names.begin(), names.end(), c.name) != names.end()) chosen.push_back(c);
  return chosen;
}

void Print(const TunedResult& r) {
  std::printf("%s: cost %.3f -> %.3f um, %d evaluations of %zu runs\n", r.controller.c_str(),
              r.cost_before_um, r.cost_after_um, r.evaluations,
              r.runs / static_cast<std::size_t>(r.evaluations));
  for (const TunedValue& v : r.values) std::printf("  %s: %.3g -> %.3g\n", v.key.c_str(), v.before, v.after);
  std::fflush(stdout);
}

int RunTune(const Options& options) {
  if (!options.from_model.empty())
    return TuneLoops({options.from_model, options.axis, options.out, options.workers, options.evaluations,
                      options.catalogue});
  if (options.out.empty()) throw ConfigError({"contour: --out: missing, expected a file for the tuned keys"});
  const ContestConfig config = LoadContest(options.contest);
  if (config.tune.controllers.empty())
    throw ConfigError({options.contest + ": tune: missing, expected what is to be tuned"});
  const int evaluations =
      options.evaluations > 0 ? options.evaluations : static_cast<int>(config.tune.evaluations);
  const auto workers = static_cast<unsigned>(ThreadsOf(static_cast<int>(options.workers)));
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  std::vector<TunedResult> results;
  for (const TunedController& c : Chosen(config.tune, options.controllers)) {
    const auto show = [&](int done, double best_um) {
      if (terminal)
        std::fprintf(stderr, "\r\x1b[K%s: %d of %d evaluations, best %.3f um", c.name.c_str(), done,
                     evaluations, best_um);
    };
    results.push_back(TuneController(config.tune, c, options.config, evaluations, workers, show));
    if (terminal) std::fputs("\r\x1b[K", stderr);
    Print(results.back());
  }
  const std::vector<std::string> axes = AxisNames(LoadEmulatedMachine(options.config).machine);
  WriteWholeFile(options.out, "# Tuned by `contour tune`, " + std::to_string(evaluations) +
                                  " evaluations each: to be merged into the machine file.\n" +
                                  TunedYaml(results, axes));
  std::cout << "wrote " << options.out << "\n";
  return kExitDone;
}

}  // namespace

void AddTuneCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand(
      "tune", "Tune every controller by the same search, cost and budget; or loops from their axes' models");
  sub->add_option("--from-model", options->from_model,
                  "Machine file: search the two-inertia loop of each axis from its model, print margins");
  sub->add_option("--axis", options->axis, "Only this axis (with --from-model)");
  sub->add_flag("--catalogue", options->catalogue,
                "With --from-model: a loop to commission with, stable for all that the model leaves open");
  sub->add_option("--config", options->config, "Machine file with an emulator: section")
      ->capture_default_str();
  sub->add_option("--contest", options->contest, "What is tuned, and on what")->capture_default_str();
  sub->add_option("--controllers", options->controllers, "Only these controllers");
  sub->add_option(
      "--evaluations", options->evaluations,
      "Budget of each; default: the contest file's; with --from-model, of each run of the search");
  sub->add_option("--threads,--workers", options->workers, "Runs at a time; default: one per processor");
  sub->add_option("--out", options->out,
                  "YAML file for the tuned keys; with --from-model, the machine file with them in it");
  sub->callback([options, &action] { action = [options] { return RunTune(*options); }; });
}

}  // namespace contour
