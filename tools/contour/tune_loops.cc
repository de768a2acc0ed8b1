#include "tools/contour/tune_loops.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <vector>

#include "analysis/parallel/parallel_for.h"
#include "config/axis_block.h"
#include "config/config_error.h"
#include "config/loop_axis.h"
#include "config/mode_advice.h"
#include "config/whole_file.h"
#include "config/yaml_tree.h"
#include "config/yaml_writer.h"
#include "core/exit_status.h"
#include "design/find_loop.h"
#include "design/loop_choice.h"
#include "design/loop_report.h"
#include "design/loop_search.h"
#include "design/start_loop.h"
#include "design/what_would_help.h"
#include "tools/machine/load_emulated_machine.h"

namespace contour {
namespace {

/// What is written is what was judged: three digits.
class Rounding {
 public:
  template <class... T>
  void Required(std::string_view, double& value, T...) {
    Round(value);
  }
  template <class... T>
  void Optional(std::string_view, double& value, T...) {
    Round(value);
  }

 private:
  static void Round(double& value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    value = std::stod(text);
  }
};

std::string Head(const std::string& name, const LoopAxis& a) {
  char text[300];
  std::snprintf(text, sizeof text,
                "axis %s: motor %.3g kg, table %.3g kg at the table, screw %.3g N/um, mode %.0f Hz%s\n",
                name.c_str(), a.axis.motor_mass_kg, a.axis.table_mass_kg, 1e-6 * a.axis.stiffness_N_m,
                ModeFrequency_Hz(a.axis), a.scale_step_m ? ", with its linear scale" : "");
  return text;
}

/// What an axis has a tuning for: a key of its own.
struct Asked {
  std::string name;  ///< of the axis
  const char* key;
  LoopAxis axis;
};

/// What has been found so far.
struct Tuned {
  std::string text;                      ///< of the machine file with it; empty: none is written
  std::vector<std::string> assignments;  ///< to put on top of the machine file
};

/// False when there is no such loop.
bool TuneLoop(const MachineConfig& machine, const Asked& loop, const TuneLoopsOptions& asked, Tuned& tuned) {
  const auto& [name, key, axis] = loop;
  const ModelConfig& model = machine.axes.at(name).model;
  const double period_s = 1e-6 * machine.machine.cycle_us;
  std::cout << Head(name, axis) << std::flush;
  LoopSearchOptions options;
  options.threads = ThreadsOf(static_cast<int>(asked.threads));
  if (asked.evaluations > 0)
    options.evaluations_per_run = options.evaluations_per_refinement = asked.evaluations;
  // Not from what the file has: the same model gives the same loop.
  if (asked.catalogue) options.members = StartSet(axis, DoubtOf(model));
  FoundLoop found = asked.catalogue ? SearchLoop(axis, period_s, options) : FindLoop(axis, period_s, options);
  Rounding rounding;
  found.tuning.Visit(rounding);
  LoopReport report = ReportOn(axis, found.tuning, period_s);
  if (asked.catalogue) {
    report.verdict = found.verdict;
    report.stick_slip.reset();
  }
  std::cout << Describe(report);
  const std::string wrong = asked.catalogue ? WhyNotToStartWith(axis, found.tuning, period_s, DoubtOf(model))
                                            : WhyRefused(found, report);
  if (!wrong.empty()) {
    std::cout << "  NO stable loop in torque mode within the limits was found; the best of "
              << found.evaluations << ": " << wrong << "\n";
    for (const std::string& help : WhatWouldHelp(axis, period_s, options.threads, true))
      std::cout << "  what would help: " << help << "\n";
    return false;
  }
  if (const auto advice = AdviceForDrive(name, machine.axes.at(name), Compliance_m_N(axis, report), period_s);
      advice && !ScaleLoopAxisOf(machine.axes.at(name)) && !asked.catalogue)
    std::cout << "  advice: " << *advice << "\n";
  const std::string block = WriteYaml(found.tuning);
  std::cout << "  axes." << name << "." << key << ":\n";
  std::string line;
  for (const char c : block) {
    if (line.empty()) line = "    ";
    line += c;
    if (c != '\n') continue;
    std::cout << line;
    line.clear();
  }
  if (!tuned.text.empty()) tuned.text = WithAxisBlock(tuned.text, asked.machine, name, key, block);
  tuned.assignments.push_back(LoopAssignment(name, found.tuning, key));
  return true;
}

/// With a linear scale also for the loop that goes by it.
bool TuneAxis(const MachineConfig& machine, const std::string& name, const TuneLoopsOptions& asked,
              Tuned& tuned) {
  const AxisConfig& config = machine.axes.at(name);
  if (!TuneLoop(machine, {name, "loop", LoopAxisOf(config)}, asked, tuned)) return false;
  const std::optional<LoopAxis> with = ScaleLoopAxisOf(config);
  return !with || TuneLoop(machine, {name, "scale_loop", *with}, asked, tuned);
}

/// Where one axis without a loop is enough for nothing to be written, those come first of which a brief look
/// finds none.
std::vector<std::string> InOrder(const MachineConfig& machine, const TuneLoopsOptions& options) {
  std::vector<std::string> names;
  for (const auto& [name, axis] : machine.axes)
    if (options.axis.empty() || name == options.axis) names.push_back(name);
  if (options.out.empty() || names.size() == 1) return names;
  const double period_s = 1e-6 * machine.machine.cycle_us;
  std::stable_partition(names.begin(), names.end(), [&](const std::string& name) {
    return !ChooseLoop(LoopAxisOf(machine.axes.at(name)), period_s);
  });
  return names;
}

/// Bounds of check go by the loop that runs: a machine file that was right may have a limit that is too
/// narrow for the one that was found.
void WarnWhereRefused(const TuneLoopsOptions& options, const Tuned& tuned) {
  try {
    LoadMaybeEmulatedMachine(options.machine, tuned.assignments);
  } catch (const ConfigError& e) {
    std::cerr << "warning: with what was found contourd refuses the machine file until this is put right:\n"
              << e.what() << "\n";
  }
}

}  // namespace

int TuneLoops(const TuneLoopsOptions& options) {
  const MachineConfig machine = LoadMaybeEmulatedMachine(options.machine).machine;
  if (!options.axis.empty() && !machine.axes.contains(options.axis))
    throw ConfigError(
        {options.machine + ": axes." + options.axis + ": missing, expected an axis of this name (--axis)"});
  Tuned tuned;
  if (!options.out.empty()) tuned.text = ReadTextFile(options.machine);
  bool all = true;
  for (const std::string& name : InOrder(machine, options)) {
    all = TuneAxis(machine, name, options, tuned) && all;
    if (all || options.out.empty()) continue;
    std::cout << "nothing was written: axis " << name << " has no loop that keeps its limits\n";
    return kExitFailed;
  }
  if (!all) return kExitFailed;
  WarnWhereRefused(options, tuned);
  if (options.out.empty()) return kExitDone;
  WriteWholeFile(options.out, tuned.text);
  std::cout << "wrote " << options.out << "\n";
  return kExitDone;
}

}  // namespace contour
