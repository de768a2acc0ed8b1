#include "tools/contour/contest_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "analysis/parallel/parallel_for.h"
#include "core/exit_status.h"
#include "tools/validation/contest/contest_plan.h"
#include "tools/validation/contest/contest_report.h"
#include "tools/validation/contest/kept_cells.h"
#include "tools/validation/contest/run_cells.h"

namespace contour {
namespace {

struct Options {
  std::string config = "config/xy_emulated.yaml";
  std::string contest = "config/contest.yaml";
  bool shorter = false;
  bool check = false;
  bool resume = false;
  std::vector<std::string> again;
  ContestChoice choice;
  std::vector<std::string> set;
  unsigned workers = 0;
  std::string out;
};

/// "123 of 3240 runs, 4 min left" on a terminal; nothing in a pipe.
class Progress {
 public:
  explicit Progress(std::size_t all) : all_(all) {}
  void Show(std::size_t done) const {
    if (!terminal_) return;
    const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    std::cerr << "\r\x1b[K" << done << " of " << all_ << " runs";
    if (done > 0 && done < all_) {
      char text[40];
      std::snprintf(text, sizeof text, ", %.1f min left",
                    elapsed_s / 60.0 * static_cast<double>(all_ - done) / static_cast<double>(done));
      std::cerr << text;
    }
    std::cerr << std::flush;
  }
  void Clear() const {
    if (terminal_) std::cerr << "\r\x1b[K" << std::flush;
  }

 private:
  std::size_t all_;
  bool terminal_ = ::isatty(STDERR_FILENO) != 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

template <class Writer>
void WriteFile(const std::filesystem::path& file, const Writer& write) {
  std::ofstream out(file, std::ios::binary);
  write(out);
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

/// The results of all cells; those that are kept are not run again.
std::vector<CellResult> RunOrRecall(const std::vector<ContestCell>& cells, KeptCells& kept,
                                    unsigned workers) {
  std::vector<CellResult> results(cells.size());
  std::vector<ContestCell> missing;
  std::vector<std::size_t> place;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (const CellResult* known = kept.Find(cells[i])) {
      results[i] = *known;
    } else {
      missing.push_back(cells[i]);
      place.push_back(i);
    }
  }
  const Progress progress(missing.size());
  RunCells(
      missing, workers, [&](std::size_t done) { progress.Show(done); },
      [&](std::size_t i, const CellResult& result) {
        results[place[i]] = result;
        kept.Keep(missing[i], result);
      });
  progress.Clear();
  return results;
}

/// The command line that does the same again.
std::string CommandText(const Options& options) {
  std::string text = "contour contest";
  if (options.contest != Options().contest) text += " --contest " + options.contest;
  if (options.shorter) text += " --short";
  const auto list = [&](const char* name, const std::vector<std::string>& values) {
    if (!values.empty()) text += std::string(" ") + name;
    for (const std::string& v : values) text += " " + v;
  };
  list("--controllers", options.choice.controllers);
  list("--programs", options.choice.programs);
  list("--machines", options.choice.machines);
  std::vector<std::string> seeds;
  for (const std::int64_t s : options.choice.seeds) seeds.push_back(std::to_string(s));
  list("--seeds", seeds);
  for (const std::string& s : options.set) text += " --set " + s;
  return text;
}

int RunContest(const Options& options) {
  const ContestConfig config = LoadContest(options.contest);
  ContestChoice choice = DefaultChoice(config, options.shorter);
  if (!options.choice.controllers.empty()) choice.controllers = options.choice.controllers;
  if (!options.choice.programs.empty()) choice.programs = options.choice.programs;
  if (!options.choice.machines.empty()) choice.machines = options.choice.machines;
  if (!options.choice.seeds.empty()) choice.seeds = options.choice.seeds;
  CheckChoice(config, choice);
  CheckControllers(config, options.again, "--again");
  const std::vector<ContestCell> cells = PlanCells(config, choice, options.config, options.set);
  std::filesystem::create_directories(options.out);
  const auto workers = static_cast<unsigned>(ThreadsOf(static_cast<int>(options.workers)));
  KeptCells kept(std::filesystem::path(options.out) / "cells.tsv", options.resume, options.again);
  const std::vector<CellResult> results = RunOrRecall(cells, kept, workers);
  const std::vector<Heat> heats = Heats(cells, results);
  const Verdict verdict = Judge(heats, config.expected, config.machines.front().name);
  const std::filesystem::path out = options.out;
  WriteFile(out / "results.csv", [&](std::ostream& o) { WriteContestCsv(o, heats); });
  WriteFile(out / "contest.md",
            [&](std::ostream& o) { WriteContestMarkdown(o, heats, verdict, CommandText(options)); });
  std::cout << VerdictText(verdict) << "wrote " << (out / "contest.md").string() << " and results.csv ("
            << cells.size() << " runs)\n";
  return options.check && !verdict.met() ? kExitFailed : kExitDone;
}

}  // namespace

void AddContestCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("contest", "Every controller on every program and machine");
  sub->add_option("--config", options->config, "Machine file with an emulator: section")
      ->capture_default_str();
  sub->add_option("--contest", options->contest, "Programs and machines")->capture_default_str();
  sub->add_flag("--short", options->shorter, "The few programs and machines of a first look");
  sub->add_option("--controllers", options->choice.controllers, "Only these controllers");
  sub->add_option("--programs", options->choice.programs, "Only these programs");
  sub->add_option("--machines", options->choice.machines, "Only these machines");
  sub->add_option("--seeds", options->choice.seeds, "These seeds")->check(CLI::NonNegativeNumber);
  sub->add_option("--set", options->set,
                  "KEY=VALUE: override a key of the machine file in every run; repeatable")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  sub->add_option("--threads,--workers", options->workers, "Runs at a time; default: one per processor");
  sub->add_flag("--check", options->check, "Exit status 1 when an aim is missed");
  auto* resume =
      sub->add_flag("--resume", options->resume, "Runs that are in the directory already are not made again");
  sub->add_option("--again", options->again, "With --resume: all runs of these controllers are made again")
      ->needs(resume);
  sub->add_option("--out", options->out, "Directory for results.csv, contest.md and cells.tsv")->required();
  sub->callback([options, &action] { action = [options] { return RunContest(*options); }; });
}

}  // namespace contour
