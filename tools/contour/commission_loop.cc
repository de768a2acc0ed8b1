#include "tools/contour/commission_loop.h"

#include <iostream>
#include <optional>
#include <stdexcept>

#include "analysis/parallel/parallel_for.h"
#include "config/friction_choice.h"
#include "config/loop_axis.h"
#include "config/whole_file.h"
#include "config/yaml_writer.h"
#include "design/find_loop.h"
#include "design/loop_report.h"
#include "design/what_would_help.h"
#include "drivers/cia402/mode_for.h"
#include "tools/contour/ends_at_once.h"

namespace contour {

void FindAndWriteLoop(const MachineConfig& machine, const std::string& axis, const ModelConfig& model,
                      const std::filesystem::path& file, const char* interrupted) {
  std::optional<EndsAtOnce> ends;
  if (interrupted != nullptr) ends.emplace(interrupted);
  AxisConfig config = machine.axes.at(axis);
  config.model = model;
  const LoopAxis loop_axis = LoopAxisOf(config);
  const double period_s = 1e-6 * machine.machine.cycle_us;
  LoopSearchOptions options;
  options.threads = ThreadsOf(0);
  options.start = config.loop;
  const FoundLoop found = FindLoop(loop_axis, period_s, options);
  const LoopReport report = ReportOn(loop_axis, found.tuning, period_s);
  std::cout << "the loop of axis " << axis << " (control.friction: linear, drive.mode: cst)\n"
            << Describe(report);
  if (const std::string wrong = WhyRefused(found, report); !wrong.empty()) {
    std::cout << "no loop in torque mode keeps its limits (" << wrong << "); none was written\n";
    for (const std::string& help : WhatWouldHelp(loop_axis, period_s, options.threads, true))
      std::cout << "  what would help: " << help << "\n";
    return;
  }
  ends.reset();
  WriteWholeFile(file, "# Found by contour from the model of axis " + axis + ": axes." + axis +
                           ".loop of a machine file, or its file.\n" + WriteYaml(found.tuning));
  std::cout << "wrote " << file.string() << "\n";
}

void FindLoopWhereItIsNoLongerGood(const MachineConfig& machine, const std::string& axis,
                                   const ModelConfig& model, const std::filesystem::path& file) {
  MachineConfig now = machine;
  AxisConfig& config = now.axes.at(axis);
  config.model = model;
  if (!config.loop || ModeFor(now.machine.controller, config.drive) != DriveMode::kCst) return;
  const bool linear = machine.control.friction == FrictionKind::kLinear;
  if (!linear && ChooseFriction(now) != FrictionKind::kLinear) return;
  const LoopReport report = ReportOn(LoopAxisOf(config), *config.loop, 1e-6 * now.machine.cycle_us);
  const std::string wrong = WhatIsWrong(report);
  if (wrong.empty()) return;
  std::cout << "with this model the loop of axis " << axis << " does not keep its limits (" << wrong
            << "). contourd warns of it at every start, and refuses it where it is unstable:\n";
  FindAndWriteLoop(machine, axis, model, file, nullptr);
}

}  // namespace contour
