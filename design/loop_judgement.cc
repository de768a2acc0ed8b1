#include "design/loop_judgement.h"

#include <optional>
#include <stdexcept>
#include <utility>

#include "core/friction_kind.h"
#include "design/loop_report.h"
#include "design/start_loop.h"
#include "design/what_would_help.h"
#include "drivers/cia402/mode_for.h"

namespace contour {
namespace {

std::optional<LoopFault> FaultOf(StatedLoop loop, double period_s) {
  try {
    const LoopReport report = ReportOn(loop.axis, loop.tuning, period_s);
    std::string wrong = WhatIsWrong(report);
    if (wrong.empty()) return std::nullopt;
    const bool as_stated = report.verdict.worst[static_cast<std::size_t>(MemberKind::kAsStated)].stable;
    return LoopFault{std::move(loop), std::move(wrong), !Limiting(report.verdict).stable, !as_stated};
  } catch (const std::invalid_argument& e) {
    return LoopFault{std::move(loop), e.what(), true, true};
  }
}

std::string Warning(const LoopFault& fault) {
  return fault.loop.key + ": found a loop that does not keep its limits (" + fault.wrong + "), and runs, " +
         (fault.unstable ? "to commission with: it is stable on the axis as stated" : "being stable") +
         "; what would help: " + kWhoTries;
}

/// A loop to commission with is stable on all that a catalogue leaves open, which is another set than what is
/// not known of an identified axis.
bool ToBeginWith(const LoopFault& fault, const MachineConfig& machine) {
  const ModelConfig& model = machine.axes.at(fault.loop.axis_name).model;
  try {
    return WhyNotToStartWith(fault.loop.axis, fault.loop.tuning, 1e-6 * machine.machine.cycle_us,
                             DoubtOf(model))
        .empty();
  } catch (const std::invalid_argument&) {
    return false;  // no loop at all: what is wrong with it is the fault's
  }
}

bool IsRefused(const LoopFault& fault, const MachineConfig& machine, LoopDemand demand) {
  if (demand == LoopDemand::kStabilityAsStated) return fault.unstable_as_stated;
  return fault.unstable && !ToBeginWith(fault, machine);
}

}  // namespace

std::vector<StatedLoop> StatedLoopsOf(const MachineConfig& machine, const std::string& name) {
  const AxisConfig& axis = machine.axes.at(name);
  std::vector<StatedLoop> loops;
  if (!axis.loop || ModeFor(machine.machine.controller, axis.drive) != DriveMode::kCst) return loops;
  const std::string key = "axes." + name + ".";
  loops.push_back({name, key + "loop", false, LoopAxisOf(axis), *axis.loop});
  const std::optional<LoopAxis> with_scale = ScaleLoopAxisOf(axis);
  if (with_scale && axis.scale_loop)
    loops.push_back({name, key + "scale_loop", true, *with_scale, *axis.scale_loop});
  return loops;
}

std::string WhyRefused(const LoopFault& fault, const std::vector<std::string>& help) {
  std::string message = fault.loop.key + ": found a loop that does not keep its limits (" + fault.wrong +
                        "), expected one that does; what would help:";
  for (const std::string& one : help) message += " " + one + ";";
  message.pop_back();
  return message;
}

std::string WhyRefused(const LoopFault& fault, double period_s) {
  return WhyRefused(fault, WhatWouldHelp(fault.loop.axis, period_s, 1));
}

std::vector<LoopFault> LoopFaults(const MachineConfig& machine) {
  std::vector<LoopFault> faults;
  if (!KnowsTwoInertias(machine.machine.controller, machine.control.friction)) return faults;
  const double period_s = 1e-6 * machine.machine.cycle_us;
  for (const auto& [name, axis] : machine.axes)
    for (StatedLoop& loop : StatedLoopsOf(machine, name))
      if (std::optional<LoopFault> fault = FaultOf(std::move(loop), period_s))
        faults.push_back(*std::move(fault));
  return faults;
}

LoopVerdicts JudgeStatedLoops(const MachineConfig& machine, LoopDemand demand) {
  LoopVerdicts verdicts;
  for (const LoopFault& fault : LoopFaults(machine)) {
    if (IsRefused(fault, machine, demand)) {
      verdicts.refused.push_back(WhyRefused(fault, {kWhoTries}));
    } else {
      verdicts.warned.push_back(Warning(fault));
    }
  }
  return verdicts;
}

}  // namespace contour
