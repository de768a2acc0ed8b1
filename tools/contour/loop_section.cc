#include "tools/contour/loop_section.h"

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "config/loop_axis.h"
#include "config/mode_advice.h"
#include "design/loop_choice.h"
#include "design/loop_judgement.h"
#include "design/loop_report.h"
#include "design/what_would_help.h"
#include "drivers/cia402/mode_for.h"

namespace contour {

namespace {

using Found = std::map<std::string, std::optional<LoopTuning>>;

/// For the axes without a loop.
Found FindMissing(const MachineConfig& machine) {
  Found found;
  for (const auto& [name, config] : machine.axes)
    if (!config.loop && ModeFor(machine.machine.controller, config.drive) == DriveMode::kCst)
      found[name] = ChooseLoop(LoopAxisOf(config), 1e-6 * machine.machine.cycle_us);
  return found;
}

/// A line where the drive is expected to draw better circles.
std::string DriveAdvice(const std::string& name, const AxisConfig& config, const LoopReport& report,
                        double period_s) {
  const auto advice = AdviceForDrive(name, config, Compliance_m_N(LoopAxisOf(config), report), period_s);
  return advice ? "  advice: " + *advice + "\n" : "";
}

/// Of an axis without a loop: what it will get.
void Chosen(const MachineConfig& machine, const std::string& name, const std::optional<LoopTuning>& tuning,
            LoopSection& section) {
  const LoopAxis axis = LoopAxisOf(machine.axes.at(name));
  const double period_s = 1e-6 * machine.machine.cycle_us;
  if (!tuning) {
    section.refused.push_back(WhyNoLoop(name, WhatWouldHelp(axis, period_s, 1)));
    return;
  }
  const LoopReport report = ReportOn(axis, *tuning, period_s);
  section.text += "  axis " + name +
                  ": no loop: in the file, so this one is chosen at start; contour tune --from-model "
                  "finds a better one\n" +
                  Describe(report) + DriveAdvice(name, machine.axes.at(name), report, period_s);
  section.chosen.push_back(LoopAssignment(name, *tuning));
}

/// `advised`: the axis that may be better off in the other mode.
void Judge(const StatedLoop& loop, const std::string& title, double period_s, bool used, LoopSection& section,
           const std::pair<const std::string, AxisConfig>* advised) {
  try {
    const LoopReport report = ReportOn(loop.axis, loop.tuning, period_s);
    section.text += title + "\n" + Describe(report);
    const std::string wrong = WhatIsWrong(report);
    if (wrong.empty()) {
      if (advised != nullptr) section.text += DriveAdvice(advised->first, advised->second, report, period_s);
      return;
    }
    // A loop that nothing uses is no danger.
    if (!used) {
      section.text += "  NOT within its limits (" + wrong + "); control.friction: linear would be refused\n";
      return;
    }
    section.refused.push_back(WhyRefused({loop, wrong}, period_s));
  } catch (const std::invalid_argument& e) {
    section.refused.push_back(loop.key + ": " + e.what());
  }
}

/// A scale that is there and moves nothing.
std::string IdleScale(const std::string& name, const AxisConfig& config) {
  if (!config.drive.linear_scale || config.scale_loop) return {};
  return "  axis " + name +
         ": its linear scale is not in the loop, there is no scale_loop: tuning; contour tune "
         "--from-model finds it\n";
}

}  // namespace

LoopSection JudgeLoops(const MachineConfig& machine) {
  LoopSection section;
  if (machine.machine.controller != ControllerName::kFull) return section;
  const double period_s = 1e-6 * machine.machine.cycle_us;
  bool used = machine.control.friction == FrictionKind::kLinear;
  const Found found = used ? FindMissing(machine) : Found{};
  const auto none = [](const auto& axis) { return !axis.second; };
  if (std::any_of(found.begin(), found.end(), none) && MayUseFilter(machine)) {
    used = false;
    section.chosen.push_back(kUseFilter);
    section.text +=
        "  none of the loops that are tried at once keeps its limits on every axis: friction is known by "
        "srukf, whose margins nobody knows; with the loops that contour tune --from-model writes it is known "
        "by linear\n";
  }
  for (const auto& axis : machine.axes) {
    const auto& [name, config] = axis;
    if (ModeFor(machine.machine.controller, config.drive) != DriveMode::kCst) continue;
    if (!config.loop && used) {
      Chosen(machine, name, found.at(name), section);
      section.text += IdleScale(name, config);
      continue;
    }
    if (!config.loop) {
      section.text += "  axis " + name + ": no loop: tuning; contour tune --from-model finds it\n";
      continue;
    }
    const bool has_scale = config.drive.linear_scale.has_value();
    for (const StatedLoop& loop : StatedLoopsOf(machine, name)) {
      const std::string title = "  axis " + name + (loop.scale ? ", with its linear scale" : "");
      Judge(loop, title, period_s, used, section, has_scale ? nullptr : &axis);
    }
    section.text += IdleScale(name, config);
  }
  if (!section.text.empty()) section.text = "\nLoops in torque mode\n" + section.text;
  return section;
}

}  // namespace contour
