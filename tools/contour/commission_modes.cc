#include "tools/contour/commission_modes.h"

#include <iostream>
#include <stdexcept>
#include <utility>

#include "analysis/parallel/parallel_for.h"
#include "config/config_error.h"
#include "config/loop_axis.h"
#include "config/machine_checks.h"
#include "design/commission_plan.h"
#include "design/start_loop.h"
#include "tools/contour/commission_record.h"
#include "tools/contour/new_daemon.h"

namespace contour {
namespace {

using nlohmann::json;

/// Of a machine that has run in torque mode alone.
constexpr const char* kDrivesOwnLoops =
    "note: in csp the position loops of all drives act, as they are tuned in the drives, which torque mode "
    "never used: tune them with the drives' own software first\n";

/// An axis that was told where it is would have to be told again.
std::string WhyNotBeginAnew(const json& status) {
  for (const json& axis : status.at("axes")) {
    const std::string reference = axis.at("reference");
    if (reference != "absolute" && reference != "never_told")
      return "axis " + axis.at("name").get<std::string>() +
             " was told where it is, which contourd forgets when it begins anew";
  }
  return {};
}

/// Of a machine in torque mode, the loops that hold their axes whatever the models leave open.
std::map<std::string, LoopTuning> LoopsThatMayStart(const MachineConfig& machine) {
  std::map<std::string, LoopTuning> loops;
  for (const auto& [name, axis] : machine.axes) {
    if (!axis.loop) continue;
    const std::string wrong =
        WhyNotToStartWith(LoopAxisOf(axis), *axis.loop, 1e-6 * machine.machine.cycle_us, DoubtOf(axis.model));
    if (wrong.empty()) loops[name] = *axis.loop;
    if (!wrong.empty())
      std::cout << "axis " << name << ": its loop is not stable for all that the model leaves open (" << wrong
                << ")\n";
  }
  return loops;
}

/// A machine in torque mode that is to be commissioned in another, or with other loops.
void RequireThatItMayChange(const MachineConfig& own, const json& status, const std::string& loops_wrong) {
  const std::string because = loops_wrong.empty() ? "" : loops_wrong + "; nor may contourd change the mode: ";
  if (own.machine.controller != ControllerName::kFull)
    throw ConfigError({because + "the controller " + std::string(Name(own.machine.controller)) +
                       " knows no csp beside torque mode: run contourd with --controller full"});
  if (const std::string why = WhyNotBeginAnew(status); !why.empty()) throw ConfigError({because + why});
  for (const ConfigProblem& p : Check(InCsp(own)))
    throw ConfigError({because + p.key + " does not do in csp: " + p.message});
}

TorqueLoops FindLoops(const MachineConfig& own, const json& status, bool drive_leads) {
  TorqueLoops found{{}, {}, WhyNotBeginAnew(status)};
  if (!found.why_not.empty()) return found;
  std::map<std::string, LoopTuning> known;
  if (!drive_leads) known = LoopsThatMayStart(own);
  std::cout << "looking for loops that hold all axes in torque mode, whatever the models leave open\n"
            << std::flush;
  return FindTorqueLoops(own, ThreadsOf(0), std::move(known));
}

}  // namespace

RecordingModes ChooseModes(const MachineConfig& own, const json& status, const CommissionOptions& options) {
  const bool leads = DriveLeads(own, options.axis), csp = options.drive || options.mode == "csp";
  if (csp) {
    if (!leads) RequireThatItMayChange(own, status, {});
    return {{}, !leads};
  }
  if (!leads) {
    const std::string wrong = WhyLoopsMayNotStart(own);
    if (wrong.empty()) return {};
    RequireThatItMayChange(own, status, wrong);
  }
  RecordingModes modes{FindLoops(own, status, leads)};
  TorqueLoops& found = modes.torque;
  if (!found.complete() && found.lacking.empty()) {
    if (options.mode == "cst") throw ConfigError({"--mode: found cst, but " + found.why_not + kCspInstead});
    std::cout << kRecordedInCsp << found.why_not << "\n";
    return {{}, !leads};
  }
  if (!leads && !found.lacking.empty()) std::cout << found.why_not << "\n";
  if (options.mode != "cst") return modes;
  for (const std::string& other : found.lacking)
    if (other != options.axis)
      throw ConfigError({"--mode: found cst, but all axes are enabled together, and axis " + other +
                         " is not known well enough for a loop that holds it in torque mode; commission it "
                         "first (--axis " +
                         other + "), or use --mode auto, which moves that axis in csp before, too"});
  return modes;
}

MachineConfig AsRecorded(const MachineConfig& own, const RecordingModes& modes) {
  if (modes.torque.complete()) return InTorqueMode(own, modes.torque.loops);
  return modes.to_csp ? InCsp(own) : own;
}

std::string Describe(const MachineConfig& own, const RecordingModes& modes, const json& status,
                     const CommissionOptions& options) {
  const bool leads = DriveLeads(own, options.axis);
  std::string text;
  for (const std::string& name : modes.torque.lacking)
    text += "in csp, to know it well enough for a loop in torque mode, " +
            Describe(PlanFor(leads ? own : InCsp(own), status, name, options));
  if (modes.torque_wanted())
    text += std::string("in torque mode, held by loops from here, and back to ") +
            (leads ? "csp" : "the machine file's loops") + " at the end (contourd begins anew each time), ";
  if (modes.to_csp)
    text +=
        "in csp, held by its drive, and back to torque mode at the end (contourd begins anew each time), ";
  text += Describe(PlanFor(AsRecorded(own, modes), status, options.axis, options));
  if (!leads && (modes.to_csp || !modes.torque.lacking.empty())) text += kDrivesOwnLoops;
  return text;
}

void EnterCsp(ModeStay& stay) {
  std::string why = "the drives do not come up in csp (0x6502)";
  try {
    if (stay.EnterCsp()) return;
  } catch (const BeginRefused& refused) {
    why = std::string("contourd does not take csp: ") + refused.what();
  }
  throw std::runtime_error("no record in csp: " + why + "; nothing was written");
}

void EnterTorqueMode(ModeStay& stay, const std::map<std::string, ModelConfig>& models, TorqueLoops& torque) {
  try {
    if (!stay.EnterTorqueMode(torque.loops, models))
      torque.why_not = "the drives do not come up in torque mode (0x6502)";
  } catch (const BeginRefused& refused) {
    torque.why_not = std::string("contourd does not take torque mode: ") + refused.what();
  }
}

}  // namespace contour
