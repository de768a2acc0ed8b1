#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <mutex>

#include "analysis/parallel/parallel_for.h"
#include "config/config_error.h"
#include "core/controller_name.h"
#include "core/exit_status.h"
#include "core/version.h"
#include "tools/validation/family/cnc_tuning.h"
#include "tools/validation/family/family_report.h"
#include "tools/validation/family/family_run.h"
#include "tools/validation/family/force_step.h"
#include "tools/validation/family/learned_circle.h"

namespace contour {
namespace {

struct Options {
  std::string folder = "config/family";
  std::string tuned = "tools/validation/family/cnc_tuned.csv";
  std::vector<std::string> machines;
  std::vector<std::string> controllers{"full", "cnc"};
  std::vector<std::string> modes{"cst", "csp"};
  std::vector<std::string> vary{""};
  std::vector<std::uint64_t> seeds{1};
  std::string programs = "BCS";
  std::string plant = "ideal";
  std::string model = "near";
  std::vector<std::string> set;
  bool maxwell_slip = false;
  bool circle = false;
  bool tune_cnc = false;
  double force_step = 0.0;
  double phase_deg = 0.0;
  std::string tune_on = "C";
  int evaluations = 20;
  int jobs = 1;
  std::string out;
};

std::string Known(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& n : names) text += (text.empty() ? "" : ", ") + n;
  return text;
}

void CheckNames(Options& o) {
  const std::vector<std::string> machines = FamilyMachines(o.folder);
  if (o.machines.empty()) o.machines = machines;
  for (const std::string& m : o.machines)
    if (std::find(machines.begin(), machines.end(), m) == machines.end())
      throw ConfigError({"--machines: found '" + m + "', expected some of " + Known(machines)});
  for (const std::string& c : o.controllers)
    if (ControllerName name{}; !FromName(c, name))
      throw ConfigError({"--controllers: found '" + c + "', expected " + std::string(Choices(name))});
  for (const char letter : o.programs) FamilyProgram(letter);
  for (const std::string& v : o.vary)
    FamilyAssignments(o.folder,
                      {o.machines.front(), FamilyPlant::kIdeal, FamilyModel::kNear, v, false, o.set});
}

/// `full` in each mode asked for; the others in the one they have.
std::vector<FamilyEntry> Entries(const Options& o) {
  std::vector<FamilyEntry> entries;
  for (const std::string& c : o.controllers) {
    if (c == "full")
      for (const std::string& mode : o.modes) entries.push_back({c, mode});
    else
      entries.push_back({c, c == "csp" || c == "cnc" ? "csp" : "cst"});
  }
  return entries;
}

FamilySetting Setting(const Options& o, const std::string& machine, const std::string& variation) {
  FamilySetting s;
  s.machine = machine;
  s.plant = o.plant == kFamilyPlants[0] ? FamilyPlant::kIdeal : FamilyPlant::kRough;
  s.model = o.model == kFamilyModels[0] ? FamilyModel::kNear : FamilyModel::kCatalogue;
  s.variation = variation;
  s.maxwell_slip = o.maxwell_slip;
  s.set = o.set;
  return s;
}

/// What `cnc` was tuned to is stated against the near model, and is the machine's, whatever model others
/// have.
void EnterCnc(const std::vector<CncTuned>& tuned, const Options& o, FamilySetting& setting) {
  const CncTuned* t = FindCncTuned(tuned, setting);
  if (t == nullptr)
    throw ConfigError({o.tuned + ": has no " + o.plant + " machine '" + setting.machine +
                       "'; contour_family --tune-cnc writes it"});
  setting.model = FamilyModel::kNear;
  for (std::string& one : CncAssignments(*t)) setting.set.push_back(std::move(one));
}

/// What a circle of the machine as it is, unvaried, tells `full`; a machine that does not draw one tells
/// nothing.
void EnterCircle(const Options& o, const FamilyEntry& entry, FamilySetting& setting) {
  FamilyCell cell{setting, entry};
  cell.setting.variation.clear();
  try {
    for (std::string& one : LearnCircle(o.folder, cell)) {
      std::fprintf(stderr, "%s: %s\n", setting.machine.c_str(), one.c_str());
      setting.set.push_back(std::move(one));
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: its circle tells nothing: %s\n", setting.machine.c_str(), e.what());
  }
}

std::vector<FamilyCell> Plan(const Options& o) {
  const std::vector<FamilyEntry> entries = Entries(o);
  const bool cnc =
      std::any_of(entries.begin(), entries.end(), [](const auto& e) { return e.controller == "cnc"; });
  const std::vector<CncTuned> tuned = cnc ? ReadCncTuned(o.tuned) : std::vector<CncTuned>{};
  std::vector<FamilyCell> cells;
  for (const std::string& machine : o.machines)
    for (const std::string& variation : o.vary)
      for (const FamilyEntry& entry : entries) {
        FamilySetting setting = Setting(o, machine, variation);
        if (entry.controller == "cnc") EnterCnc(tuned, o, setting);
        if (entry.controller == "full" && o.circle) EnterCircle(o, entry, setting);
        for (const char program : o.programs)
          for (const std::uint64_t seed : o.seeds) cells.push_back({setting, entry, program, seed});
      }
  return cells;
}

class Progress {
 public:
  explicit Progress(std::size_t all) : all_(all) {}
  void Show(std::size_t done) const {
    if (terminal_) std::fprintf(stderr, "\r\x1b[K%zu of %zu%s", done, all_, done == all_ ? "\r\x1b[K" : "");
  }

 private:
  std::size_t all_;
  bool terminal_ = ::isatty(STDERR_FILENO) != 0;
};

template <class Writer>
void WriteFile(const std::string& file, const Writer& write) {
  std::ofstream out(file, std::ios::binary);
  write(out);
  out.close();
  if (!out) throw EnvironmentError("cannot write " + file);
}

/// On machines with a scale, whichever of motor and dual loop draws the better circle.
int TuneAll(const Options& o) {
  const FamilyPlant plant = Setting(o, "", "").plant;
  std::vector<CncTuned> tuned(o.machines.size());
  const Progress progress(tuned.size());
  std::mutex mutex;
  std::size_t done = 0;
  ParallelFor(tuned.size(), o.jobs, [&](std::size_t i) {
    CncTask task{o.machines[i], plant, false, o.tune_on.front(), o.evaluations};
    tuned[i] = TuneCnc(o.folder, task);
    const MaybeEmulatedMachineFile file = LoadMaybeEmulatedMachine(o.folder + "/" + o.machines[i] + ".yaml");
    const bool scale = std::all_of(file.machine.axes.begin(), file.machine.axes.end(), [](const auto& axis) {
      return axis.second.drive.linear_scale.has_value();
    });
    if (scale) {
      task.dual_loop = true;
      const CncTuned dual = TuneCnc(o.folder, task);
      if (dual.after_um < tuned[i].after_um) tuned[i] = dual;
    }
    const std::lock_guard lock(mutex);
    progress.Show(++done);
  });
  if (o.out.empty())
    WriteCncTuned(std::cout, tuned);
  else
    WriteFile(o.out, [&](std::ostream& out) { WriteCncTuned(out, tuned); });
  return kExitDone;
}

int StepForces(const Options& o) {
  std::vector<FamilyCell> cells = Plan(o);
  std::erase_if(cells, [&](const FamilyCell& c) { return c.program != o.programs.front(); });
  std::vector<ForceStepResult> results(cells.size());
  ParallelFor(cells.size(), o.jobs, [&](std::size_t i) {
    results[i] = RunForceStep(o.folder, cells[i], {o.force_step, o.phase_deg});
  });
  WriteForceSteps(std::cout, cells, results);
  return kExitDone;
}

int Run(Options o) {
  CheckNames(o);
  o.jobs = ThreadsOf(o.jobs);
  if (o.tune_cnc) return TuneAll(o);
  if (o.force_step > 0.0) return StepForces(o);
  const std::vector<FamilyCell> cells = Plan(o);
  const Progress progress(cells.size());
  const std::vector<FamilyResult> results =
      RunFamily(o.folder, cells, o.jobs, [&](std::size_t done) { progress.Show(done); });
  if (!o.out.empty()) WriteFile(o.out, [&](std::ostream& out) { WriteFamilyCsv(out, cells, results); });
  WriteFamilyTable(std::cout, cells, results);
  WriteFamilyRatios(std::cout, cells, results);
  return kExitDone;
}

void AddOptions(CLI::App& app, Options& o) {
  app.add_option("--family", o.folder, "Folder of machine files")->capture_default_str();
  app.add_option("--machines", o.machines, "Only these; default: all of the folder");
  app.add_option("--controllers", o.controllers, "Controllers")->capture_default_str();
  app.add_option("--modes", o.modes, "Of `full`")
      ->check(CLI::IsMember({"cst", "csp"}))
      ->capture_default_str();
  app.add_option("--programs", o.programs,
                 "B: 100 um circle at pi/4 Hz, C: 10 mm circle at 3 m/min, S: 10 mm square, 5 um at corners")
      ->capture_default_str();
  app.add_option("--seeds", o.seeds, "Seeds of the emulated machine")->capture_default_str();
  app.add_option("--plant", o.plant,
                 "rough: friction on the motor side, a side mode, dead time and lead wobble besides")
      ->check(CLI::IsMember(std::vector<std::string>(kFamilyPlants.begin(), kFamilyPlants.end())))
      ->capture_default_str();
  app.add_option("--model", o.model,
                 "near: K 2 %, inertias 5 %, friction 20 % off; catalogue: as the file has it")
      ->check(CLI::IsMember(std::vector<std::string>(kFamilyModels.begin(), kFamilyModels.end())))
      ->capture_default_str();
  app.add_flag("--maxwell-slip", o.maxwell_slip, "Maxwell-slip friction instead of LuGre");
  app.add_option("--vary", o.vary, "Changes of the emulated machine, each alone; '' is none");
  app.add_option("--set", o.set, "KEY=VALUE on top of the machine file, axes.* for every axis; repeatable")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--force-step", o.force_step,
                 "Instead: what a force across the path, in that of rated torque, moves the table during C")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--phase", o.phase_deg, "Of the third turn of C at which that force comes, degrees from +X")
      ->check(CLI::Range(0.0, 360.0))
      ->capture_default_str();
  app.add_option("--cnc", o.tuned, "What cnc was tuned to")->capture_default_str();
  app.add_flag("--circle", o.circle,
               "`full` knows what one measured circle tells of friction before the screw and of its lead");
  app.add_flag("--tune-cnc", o.tune_cnc, "Tune cnc on each machine's 10 mm circle instead");
  app.add_option("--tune-on", o.tune_on, "Another program than the 10 mm circle")
      ->check(CLI::IsMember({"B", "C", "S"}))
      ->capture_default_str();
  app.add_option("--evaluations", o.evaluations, "Of tuning, per key")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--jobs,--threads", o.jobs, "Runs at a time; 0: one per processor")->capture_default_str();
  app.add_option("--out", o.out, "CSV file: a row per run, or per machine tuned");
}

}  // namespace
}  // namespace contour

int main(int argc, char** argv) {
  CLI::App app{"Controllers on a family of emulated machines: peaks at the table over F / K, then a hold."};
  app.set_version_flag("--version", std::string("contour_family ") + CONTOUR_VERSION);
  contour::Options options;
  contour::AddOptions(app, options);
  try {
    app.parse(argc, argv);
    return contour::Run(options);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? contour::kExitDone : contour::kExitBadUsage;
  } catch (const contour::ConfigError& e) {
    std::fprintf(stderr, "contour_family: %s\n", e.what());
    return contour::kExitBadUsage;
  } catch (const contour::EnvironmentError& e) {
    std::fprintf(stderr, "contour_family: %s\n", e.what());
    return contour::kExitEnvironment;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "contour_family: %s\n", e.what());
    return contour::kExitFailed;
  }
}
