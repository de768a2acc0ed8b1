#include "tools/contour/commission_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "analysis/axis_model/read_stated_axis.h"
#include "analysis/identification/result_files.h"
#include "analysis/identification/usable.h"
#include "analysis/parallel/parallel_for.h"
#include "config/config_error.h"
#include "core/exit_status.h"
#include "design/torque_loops.h"
#include "tools/contour/commission_drive.h"
#include "tools/contour/commission_loop.h"
#include "tools/contour/commission_modes.h"
#include "tools/contour/commission_record.h"
#include "tools/contour/daemon_link.h"
#include "tools/contour/ends_at_once.h"
#include "tools/contour/identification_report.h"
#include "tools/contour/mode_stay.h"
#include "tools/contour/stop_signals.h"

namespace contour {
namespace {

using nlohmann::json;

bool Confirmed(const CommissionOptions& options) {
  if (options.yes) return true;
  if (::isatty(STDIN_FILENO) == 0)
    throw ConfigError({"commission moves the machine: confirm with --yes (there is no terminal to ask on)"});
  std::cout << "The axis will be enabled and will move. Go on? [yes/no] " << std::flush;
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "yes";
}

/// What must hold before anything moves; throws with what does not.
void CheckBeforehand(MachineConfig& machine, const json& status, const CommissionOptions& options) {
  if (!machine.axes.contains(options.axis))
    throw ConfigError({"--axis: the daemon's machine has no axis \"" + options.axis + "\""});
  const std::string state = status.at("state");
  if (state != "Idle" && state != "Ready")
    throw std::runtime_error("commissioning begins from Idle or Ready, but the machine is " +
                             StateSentence(status));
  const std::string controller = status.at("controller");
  if (!FromName(controller, machine.machine.controller))
    throw std::runtime_error("the daemon runs a controller that this program does not know: " + controller);
}

/// Says so where the controller believes a model that may be far off.
void Advise(const MachineConfig& machine) {
  const ControllerName controller = machine.machine.controller;
  const bool certain =
      controller == ControllerName::kMpcObserver || KnowsTwoInertias(controller, machine.control.friction);
  if (!certain)
    std::cout << "note: the controller " << Name(controller)
              << " may swing where the model is far off; full with control.friction: linear and the loop of "
                 "contour tune --from-model FILE --catalogue does not\n";
}

/// What is to be identified of an axis from its record.
IdentificationJob JobOf(const MachineConfig& machine, const std::string& name, CommissionRecord record,
                        const CommissionOptions& options) {
  IdentificationJob job;
  // Of what the drive's own loop does to a chirp its reports show but two values a period.
  if (DriveLeads(machine, name))
    job.to_try =
        "in csp the torque is what the drive reports, which does not show all of it: where the drive can, "
        "commission in torque mode (--mode cst); a model that states what is known (uncertainty:) makes a "
        "loop for it more likely";
  job.shaken = true;
  job.for_screw = MoreOfTheScrew(machine.axes.at(name), LimitsFor(machine, name, options).travel_mm);
  job.stated = diagnosis::ToStatedAxis(machine, name);
  job.model = machine.axes.at(name).model;
  job.logs.push_back(std::move(record.log));
  job.lost_cycles = record.lost_cycles;
  job.sources = {"commissioning of axis " + name + " of " + machine.machine.name};
  job.out = options.out.empty() ? name + "_model.yaml" : options.out;
  job.report = options.report.empty() ? name + "_commissioning" : options.report;
  return job;
}

/// An axis as its record has it.
struct Found {
  IdentificationJob job;
  identify::Identification id;
};

/// Takes from seconds to a minute. Nothing moves, and nothing is written yet: a signal need not wait for it.
identify::Identification IdentifyUnlessInterrupted(const IdentificationJob& job) {
  ThrowIfInterrupted();
  const EndsAtOnce ends("contour: interrupted while it identified; nothing was written\n");
  return IdentifyWithProgress(job);
}

TorqueLoops FindTorqueLoopsUnlessInterrupted(const MachineConfig& machine, const TorqueLoops& found) {
  ThrowIfInterrupted();
  const EndsAtOnce ends("contour: interrupted while it looked for loops; nothing was written\n");
  return FindTorqueLoops(machine, ThreadsOf(0), found.loops);
}

void FindAndWriteLoopUnlessInterrupted(const MachineConfig& machine, const ModelConfig& model,
                                       const CommissionOptions& options) {
  constexpr const char* kWithoutLoop =
      "contour: interrupted while it looked for the loop; the model is written, a loop is not\n";
  ThrowIfInterrupted("the model is written, a loop is not");
  FindAndWriteLoop(machine, options.axis, model,
                   options.loop.empty() ? options.axis + "_loop.yaml" : options.loop, kWithoutLoop);
}

/// Axes that have no loop for torque mode are recorded in csp: what that tells of them, however unsure, is
/// nearer than a catalogue, and may leave so little open that there is one. The machine's own mode is back
/// before anything is computed: an interrupt then ends the command at once.
std::map<std::string, Found> RecordInCspFirst(std::unique_ptr<ControlClient>& client, ModeStay& stay,
                                              const std::vector<std::string>& axes, const MachineConfig& own,
                                              const CommissionOptions& options) {
  const bool leads = DriveLeads(own, options.axis);
  const MachineConfig machine = leads ? own : InCsp(own);
  if (!leads) EnterCsp(stay);
  std::map<std::string, Found> found;
  for (const std::string& name : axes) {
    std::cout << "axis " << name << ", in csp first\n" << std::flush;
    found[name].job = JobOf(
        machine, name, Record(*client, machine, PlanFor(machine, Status(*client), name, options)), options);
  }
  stay.Leave();
  for (auto& [name, f] : found) f.id = IdentifyUnlessInterrupted(f.job);
  return found;
}

/// The machine with what was found in csp, as far as it is nearer than a catalogue.
MachineConfig KnownBetter(MachineConfig machine, const std::map<std::string, Found>& found) {
  for (const auto& [name, f] : found) {
    const std::string why = identify::WhyNoBeginning(f.id);
    if (why.empty()) machine.axes.at(name).model = identify::ToModel(f.id, f.job.model);
    if (!why.empty()) std::cout << "note: that says too little of axis " << name << ": " << why << "\n";
  }
  return machine;
}

/// A stop in torque mode may be the loop's from here, or a fault of the axis that nobody should enable it
/// again with: the drive's own loop is named, and left to who has looked at the axis.
constexpr const char* kInCspInstead =
    ". Nothing was written, and nothing is tried again by itself. If the axis is sound (look at it first), "
    "its drive's own loop can hold it for the record, where the drive has csp: contourd anew, then contour "
    "commission --mode csp";

CommissionRecord RecordOrName(ControlClient& client, const MachineConfig& machine,
                              const CommissionOptions& options) {
  try {
    return Record(client, machine, PlanFor(machine, Status(client), options.axis, options));
  } catch (const MachineStopped& stopped) {
    if (DriveLeads(machine, options.axis)) throw;
    throw std::runtime_error(std::string(stopped.what()) + kInCspInstead);
  }
}

int Commission(std::unique_ptr<ControlClient>& client, ModeStay& stay, const MachineConfig& own,
               RecordingModes modes, const CommissionOptions& options) {
  MachineConfig machine = AsRecorded(own, modes);
  TorqueLoops& torque = modes.torque;
  const bool torque_wanted = modes.torque_wanted();
  std::map<std::string, Found> in_csp;
  std::map<std::string, ModelConfig> models;
  if (!torque.lacking.empty()) {
    in_csp = RecordInCspFirst(client, stay, torque.lacking, own, options);
    const MachineConfig known = KnownBetter(own, in_csp);
    for (const auto& [name, found] : in_csp) models[name] = known.axes.at(name).model;
    torque = FindTorqueLoopsUnlessInterrupted(known, torque);
    if (torque.complete()) machine = InTorqueMode(known, torque.loops);
  }
  if (torque.complete()) EnterTorqueMode(stay, models, torque);
  if (torque_wanted && !torque.complete()) {
    if (options.mode == "cst")
      throw std::runtime_error("no record in torque mode: " + torque.why_not + kCspInstead);
    std::cout << kRecordedInCsp << torque.why_not << "\n";
    modes.to_csp = !DriveLeads(own, options.axis);
    machine = AsRecorded(own, modes);
  }
  Found found;
  if (!torque.complete() && in_csp.contains(options.axis)) {
    found = std::move(in_csp.at(options.axis));
  } else {
    if (modes.to_csp) EnterCsp(stay);
    CommissionRecord record = RecordOrName(*client, machine, options);
    stay.Leave();
    if (options.drive)
      return ReportOnDrive(machine, options.axis, record.drive_samples,
                           options.out.empty() ? options.axis + "_drive.json" : options.out);
    found.job = JobOf(machine, options.axis, std::move(record), options);
    found.id = IdentifyUnlessInterrupted(found.job);
  }
  const ModelConfig model = Report(found.job, found.id);
  FindAndWriteLoopUnlessInterrupted(machine, model, options);
  return kExitDone;
}

/// --yes answers for the axis that was named: who is asked reads which others move.
void RequireThatOthersMayMove(const RecordingModes& modes, const CommissionOptions& options) {
  if (!options.yes || options.other_axes) return;
  for (const std::string& other : modes.torque.lacking)
    if (other != options.axis)
      throw ConfigError({"--yes: before axis " + options.axis + " is recorded in torque mode, axis " + other +
                         " would move, too (in csp, for a loop that holds it); grant it with --other_axes, "
                         "commission that axis first (--axis " +
                         other + "), or record in csp alone (--mode csp)"});
}

int RunCommission(const CommissionOptions& options) {
  auto client = std::make_unique<ControlClient>(ConnectToDaemon(options.socket));
  MachineConfig own = AskForMachine(*client);
  CheckBeforehand(own, StatusOnceStarted(*client), options);
  const RecordingModes modes = ChooseModes(own, Status(*client), options);
  std::cout << Describe(own, modes, Status(*client), options);
  RequireThatOthersMayMove(modes, options);
  if (!options.drive) Advise(AsRecorded(own, modes));
  if (!Confirmed(options)) {
    std::cout << "nothing was moved\n";
    return kExitFailed;
  }
  StopOnSignals();
  ModeStay stay(client, options.socket);
  try {
    return Commission(client, stay, own, modes, options);
  } catch (const std::exception&) {
    stay.LeaveOrSay();
    throw;
  }
}

}  // namespace

void AddCommissionCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<CommissionOptions>();
  CLI::App* sub = app.add_subcommand(
      "commission",
      "Move an axis of a running contourd within limits, and identify its friction and mechanics");
  sub->add_option("--axis", options->axis, "The axis")->required();
  AddSocketOption(*sub, options->socket);
  sub->add_option("--travel_mm", options->travel_mm,
                  "Whole way (default: a tenth of the stroke, at most 20 mm; a turn of the motor at least)");
  sub->add_option("--max_speed_mm_s", options->max_speed_mm_s,
                  "Largest speed (default: 40 % of the axis's limit, at most 100 mm/s)");
  sub->add_option("--max_torque_Nm", options->max_torque_Nm,
                  "Torque at which it stops (default: 60 % of the axis's limit, or what its ramps may take)");
  sub->add_option("--out", options->out, "Model file to write (default: NAME_model.yaml)");
  sub->add_option("--loop", options->loop, "Loop file to write (default: NAME_loop.yaml)");
  sub->add_option("--report", options->report, "Directory of the report (default: NAME_commissioning)");
  sub->add_option(
         "--mode", options->mode,
         "What the drives are in while the axis is recorded, whatever they run in: cst, csp, or auto: cst "
         "where a loop is stable for all that the models leave open, or what a record in csp leaves open")
      ->check(CLI::IsMember({"auto", "cst", "csp"}));
  sub->add_flag(
      "--drive", options->drive,
      "Measure the loop that the drive closes (csp), and what it can do, instead of the axis; --out "
      "is then NAME_drive.json");
  sub->add_flag("--yes", options->yes, "Do not ask before the axis is enabled and moves");
  sub->add_flag("--other_axes", options->other_axes,
                "With --yes: other axes may move, too, where they have to be recorded before");
  sub->footer(
      "Enables the machine, runs its motions one after the other, and takes the torque off at the end. An "
      "interrupt (Ctrl-C) stops the axis, takes the torque off and ends with status 1; while it identifies, "
      "at once.");
  sub->callback([options, &action] { action = [options] { return RunCommission(*options); }; });
}

}  // namespace contour
