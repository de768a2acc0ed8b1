#include "tools/contour/commission_command.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "analysis/axis_model/read_stated_axis.h"
#include "analysis/identification/result_files.h"
#include "analysis/identification/usable.h"
#include "analysis/parallel/parallel_for.h"
#include "analysis/recording/record_axis.h"
#include "config/config_error.h"
#include "config/load_machine.h"
#include "daemon/control_socket/base64.h"
#include "design/commission_plan.h"
#include "design/drive_motions.h"
#include "design/start_loop.h"
#include "design/torque_loops.h"
#include "drivers/cia402/mode_for.h"
#include "drivers/lcm/cycle_messages.h"
#include "tools/contour/commission_drive.h"
#include "tools/contour/commission_loop.h"
#include "tools/contour/daemon_link.h"
#include "tools/contour/ends_at_once.h"
#include "tools/contour/identification_report.h"
#include "tools/contour/new_daemon.h"
#include "tools/contour/torque_mode_stay.h"

namespace contour {
namespace {

using nlohmann::json;

struct Options {
  std::string axis;
  std::string socket;
  std::optional<double> travel_mm, max_speed_mm_s, max_torque_Nm;
  std::string out;
  std::string report;
  std::string loop;
  std::string mode = "auto";
  bool drive = false;
  bool yes = false;
};

constexpr std::chrono::milliseconds kLookEvery{100};
constexpr std::chrono::seconds kEnableLimit{60};
constexpr std::chrono::seconds kLastRows{5};
constexpr const char* kCspInstead =
    "; contour commission --mode csp records it there, held by the drive's own loop";
constexpr const char* kStays =
    "note: recorded in csp, where the drive's reports are what is known of its torque: ";

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");
void OnSignal(int /*signal*/) { stop_requested.store(true); }

/// Takes every cycle from the daemon and watches that the axis keeps to what the operator allowed.
class Watchman {
 public:
  Watchman(ControlClient& client, std::size_t axis, double period_s, const RecordedTorque& torque,
           CommissionPlan plan, double radius_m_rad)
      : axis_(axis),
        reported_(torque.reported),
        plan_(std::move(plan)),
        recorder_(axis, period_s, torque),
        drive_recorder_(axis, radius_m_rad) {
    client.OnMessage([this](const json& message) { OnMessage(message); });
    AskOrThrow(client, {{"request", "rows"}, {"on", true}});
  }
  [[nodiscard]] const std::string& offence() const { return offence_; }
  [[nodiscard]] std::uint64_t newest_cycle() const { return newest_cycle_; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  AxisRecorder& recorder() { return recorder_; }
  [[nodiscard]] const std::vector<DriveSample>& drive_samples() const { return drive_recorder_.samples(); }

 private:
  void OnMessage(const json& message) {
    if (!message.contains("rows")) return;
    lost_ = message.at("lost");
    for (const json& text : message.at("rows")) {
      const auto row = FromBase64(text.get<std::string>());
      contour_lcm::cycle_entry raw{};
      if (!row || !Decode(*row, raw) || !FromMessage(raw, entry_))
        throw std::runtime_error(
            "contourd sends rows that this program cannot read; are they of one version?");
      newest_cycle_ = entry_.output.record.cycle;
      recorder_.Add(entry_.output.record);
      drive_recorder_.Add(entry_.output.record);
      Watch(entry_.output.record);
    }
  }
  void Watch(const CycleRecord& record) {
    if (axis_ >= record.axes.size() || record.state != MachineState::kRunning) return;
    const AxisRecord& a = record.axes[axis_];
    char text[160];
    text[0] = '\0';
    const double torque_Nm = reported_ ? a.feedback.torque_Nm : a.torque_Nm;
    if (std::fabs(torque_Nm) > plan_.limits.max_torque_Nm)
      std::snprintf(text, sizeof text, "torque of %.3f Nm is beyond --max_torque_Nm", torque_Nm);
    if (a.position_m < plan_.low_mm * 1e-3 || a.position_m > plan_.high_mm * 1e-3)
      std::snprintf(text, sizeof text, "position %.3f mm is beyond --travel_mm", a.position_m * 1e3);
    if (std::fabs(a.reference.velocity_m_s) > plan_.limits.max_speed_mm_s * 1.001e-3)
      std::snprintf(text, sizeof text, "speed of %.3f mm/s is beyond --max_speed_mm_s",
                    a.reference.velocity_m_s * 1e3);
    if (offence_.empty()) offence_ = text;
  }

  std::size_t axis_;
  bool reported_;  ///< the drive makes the torque
  const CommissionPlan plan_;
  AxisRecorder recorder_;
  DriveRecorder drive_recorder_;
  CycleEntry entry_;
  std::string offence_;
  std::uint64_t newest_cycle_ = 0;
  std::uint64_t lost_ = 0;
};

/// What a loop in torque mode may have brought about, and a drive's own loop does not.
bool MayBeTheLoops(const std::string& reason) {
  for (const char* one : {"following_error", "velocity_limit", "oscillation", "feedback_reversed"})
    if (reason == one) return true;
  return false;
}

/// The machine stopped by itself, which may be its loop's doing.
class MachineStopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs one motion to its end; stops the machine and throws when something is not as it should be.
void RunMotion(ControlClient& client, Watchman& watchman, const CommissionMotion& motion,
               const std::string& progress) {
  const json reply = RunProgram(client, {{"request", "run"},
                                         {"name", "commissioning: " + motion.what},
                                         {"format", "yaml"},
                                         {"from_here", true},
                                         {"text", motion.yaml}});
  const std::uint32_t id = reply.at("program_id");
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  bool stopping = false;
  for (;;) {
    const json status = Status(client);
    const std::string state = status.at("state");
    const json& program = status.at("program");
    const bool ours = program.at("id") == id;
    if (!ours || (state == "Ready" && status.at("reason") != "none") ||
        (state != "Ready" && state != "Running" && state != "Stopping")) {
      if (ours && status.at("reason") == "program_end") return;
      if (!watchman.offence().empty()) throw std::runtime_error("stopped: " + watchman.offence());
      const std::string message = "\"" + motion.what + "\" did not end by itself: " + StateSentence(status);
      if (state == "Faulted" && !stopping && MayBeTheLoops(status.at("reason")))
        throw MachineStopped(message);
      throw std::runtime_error(message);
    }
    if (terminal && program.at("time_s").is_number() && program.at("duration_s").is_number())
      std::fprintf(stderr, "\r\x1b[K%s  %s  %.1f of %.1f s", progress.c_str(), motion.what.c_str(),
                   program.at("time_s").get<double>(), program.at("duration_s").get<double>());
    if ((stop_requested || !watchman.offence().empty()) && !stopping) {
      stopping = true;
      client.Ask({{"request", "stop"}});
      // A second one is the shortest stop there is.
      if (!watchman.offence().empty()) client.Ask({{"request", "stop"}});
    }
    const auto until = std::chrono::steady_clock::now() + kLookEvery;
    while (std::chrono::steady_clock::now() < until)
      client.Listen(std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now()));
  }
}

bool Confirmed(const Options& options) {
  if (options.yes) return true;
  if (::isatty(STDIN_FILENO) == 0)
    throw ConfigError({"commission moves the machine: confirm with --yes (there is no terminal to ask on)"});
  std::cout << "The axis will be enabled and will move. Go on? [yes/no] " << std::flush;
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "yes";
}

/// The place of the axis among those of the status.
std::size_t NumberOf(const json& status, const std::string& axis) {
  std::size_t number = 0;
  while (status.at("axes").at(number).at("name") != axis) ++number;
  return number;
}

bool DriveLeads(const MachineConfig& machine, const std::string& axis) {
  return ModeFor(machine.machine.controller, machine.axes.at(axis).drive) == DriveMode::kCsp;
}

/// What must hold before anything moves; throws with what does not.
void CheckBeforehand(MachineConfig& machine, const json& status, const Options& options) {
  if (!machine.axes.contains(options.axis))
    throw ConfigError({"--axis: the daemon's machine has no axis \"" + options.axis + "\""});
  const std::string state = status.at("state");
  if (state != "Idle" && state != "Ready")
    throw std::runtime_error("commissioning begins from Idle or Ready, but the machine is " +
                             StateSentence(status));
  const std::string controller = status.at("controller");
  if (!FromName(controller, machine.machine.controller))
    throw std::runtime_error("the daemon runs a controller that this program does not know: " + controller);
  if (const std::string wrong = WhyLoopsMayNotStart(machine); !wrong.empty()) throw ConfigError({wrong});
  const bool drive_holds = DriveLeads(machine, options.axis);
  if (options.mode == "csp" && !drive_holds)
    throw ConfigError({"--mode: found csp, but axis " + options.axis +
                       " is held from here, not by its drive: run contourd with --set axes." + options.axis +
                       ".drive.mode=csp"});
  if (options.drive && !drive_holds)
    throw ConfigError({"--drive: axis " + options.axis +
                       " is held from here, not by its drive: run contourd with --set axes." + options.axis +
                       ".drive.mode=csp"});
}

/// What the operator allowed goes for the axis that was asked for.
CommissionPlan PlanFor(const MachineConfig& machine, const json& status, const std::string& name,
                       const Options& options) {
  CommissionLimits limits = DefaultCommissionLimits(machine.axes.at(name));
  if (name == options.axis) {
    if (options.travel_mm) limits.travel_mm = *options.travel_mm;
    if (options.max_speed_mm_s) limits.max_speed_mm_s = *options.max_speed_mm_s;
    if (options.max_torque_Nm) limits.max_torque_Nm = *options.max_torque_Nm;
  }
  const json& axis = status.at("axes").at(NumberOf(status, name));
  const double position_mm = 1e3 * axis.at("position_m").get<double>();
  CommissionPlan plan = PlanCommissioning(machine, name, position_mm, limits);
  if (options.drive)
    plan.motions = DriveMotions(plan, machine.axes.at(name), position_mm, machine.machine.cycle_us);
  return plan;
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

/// Whether to record in torque mode what runs in csp, and with which loops. There every force is known that
/// acts; but a loop from here has to hold the axes.
TorqueLoops LoopsToRecordWith(const MachineConfig& machine, const json& status, const Options& options) {
  if (options.drive || options.mode == "csp" || !DriveLeads(machine, options.axis)) return {};
  TorqueLoops found{{}, {}, WhyNotBeginAnew(status)};
  if (found.why_not.empty()) {
    std::cout << "looking for loops that hold all axes in torque mode, whatever the models leave open\n"
              << std::flush;
    found = FindTorqueLoops(machine, ThreadsOf(0));
  }
  if (!found.complete() && found.lacking.empty()) {
    if (options.mode == "cst") throw ConfigError({"--mode: found cst, but " + found.why_not + kCspInstead});
    std::cout << kStays << found.why_not << "\n";
  }
  if (options.mode != "cst") return found;
  for (const std::string& other : found.lacking)
    if (other != options.axis)
      throw ConfigError({"--mode: found cst, but all axes are enabled together, and axis " + other +
                         " is not known well enough for a loop that holds it in torque mode; commission it "
                         "first (--axis " +
                         other + "), or use --mode auto, which moves that axis in csp before, too"});
  return found;
}

/// Enables, moves, takes the torque off; the record is the watchman's.
void MoveAxis(ControlClient& client, Watchman& watchman, const CommissionPlan& plan) {
  AskOrThrow(client, {{"request", "enable"}});
  const json status = WaitForStatus(
      client, [](const json& s) { return s.at("state") != "Enabling" && s.at("state") != "Idle"; },
      kEnableLimit);
  if (status.at("state") != "Ready")
    throw std::runtime_error("could not be enabled: " + StateSentence(status));
  std::exception_ptr failure;
  try {
    for (std::size_t i = 0; i < plan.motions.size(); ++i)
      RunMotion(client, watchman, plan.motions[i],
                std::to_string(i + 1) + " of " + std::to_string(plan.motions.size()));
  } catch (const std::exception&) {
    failure = std::current_exception();
  }
  if (::isatty(STDERR_FILENO) != 0) std::fputs("\r\x1b[K", stderr);
  // Whatever happened, the torque goes off again.
  const std::uint64_t last = Status(client).at("cycle");
  client.Ask({{"request", "disable"}});
  if (failure) std::rethrow_exception(failure);
  const auto deadline = std::chrono::steady_clock::now() + kLastRows;
  while (watchman.newest_cycle() < last && std::chrono::steady_clock::now() < deadline)
    client.Listen(kLookEvery);
  AskOrThrow(client, {{"request", "rows"}, {"on", false}});
  std::printf("%.1f s of motion recorded", watchman.recorder().seconds());
  if (watchman.lost() > 0)
    std::printf("; %llu cycles LOST on the way: this computer is too slow",
                static_cast<unsigned long long>(watchman.lost()));
  std::printf("\n");
  std::fflush(stdout);
}

/// Moves an axis; what was recorded is the watchman's.
std::unique_ptr<Watchman> Record(ControlClient& client, const MachineConfig& machine,
                                 const CommissionPlan& plan) {
  const AxisConfig& axis = machine.axes.at(plan.axis);
  const RecordedTorque torque{DriveLeads(machine, plan.axis),
                              static_cast<std::size_t>(axis.drive.delay_cycles), 1e-3 * axis.drive.lag_ms};
  auto watchman =
      std::make_unique<Watchman>(client, NumberOf(Status(client), plan.axis), machine.machine.cycle_us * 1e-6,
                                 torque, plan, ToSi(axis.model.mechanics).radius_m_rad);
  // The connection may outlive it.
  const auto leave_alone = [&client] { client.OnMessage([](const json&) {}); };
  try {
    MoveAxis(client, *watchman, plan);
  } catch (const std::exception&) {
    leave_alone();
    throw;
  }
  leave_alone();
  return watchman;
}

/// What is to be identified of an axis from its record.
IdentificationJob JobOf(const MachineConfig& machine, const std::string& name, Watchman& watchman,
                        const Options& options) {
  IdentificationJob job;
  // Of what the drive's own loop does to a chirp its reports show but two values a period.
  if (DriveLeads(machine, name))
    job.to_try =
        "in csp the torque is what the drive reports, which does not show all of it: where the drive can, "
        "commission in torque mode (--mode cst); a model that states what is known (uncertainty:) makes a "
        "loop for it more likely";
  job.stated = diagnosis::ToStatedAxis(machine, name);
  job.model = machine.axes.at(name).model;
  job.logs.push_back(watchman.recorder().Take());
  job.lost_cycles = watchman.lost();
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
  if (stop_requested) throw std::runtime_error("interrupted; nothing was written");
  const EndsAtOnce ends("contour: interrupted while it identified; nothing was written\n");
  return IdentifyWithProgress(job);
}

TorqueLoops FindTorqueLoopsUnlessInterrupted(const MachineConfig& machine, const TorqueLoops& found) {
  if (stop_requested) throw std::runtime_error("interrupted; nothing was written");
  const EndsAtOnce ends("contour: interrupted while it looked for loops; nothing was written\n");
  return FindTorqueLoops(machine, ThreadsOf(0), found.loops);
}

void FindAndWriteLoopUnlessInterrupted(const MachineConfig& machine, const ModelConfig& model,
                                       const Options& options) {
  constexpr const char* kWithoutLoop =
      "contour: interrupted while it looked for the loop; the model is written, a loop is not\n";
  if (stop_requested) throw std::runtime_error("interrupted; the model is written, a loop is not");
  FindAndWriteLoop(machine, options.axis, model,
                   options.loop.empty() ? options.axis + "_loop.yaml" : options.loop, kWithoutLoop);
}

/// Axes that have no loop for torque mode are recorded in csp: what that tells of them, however unsure, is
/// nearer than a catalogue, and may leave so little open that there is one. `machine` gets their models.
std::map<std::string, Found> KnowBetter(ControlClient& client, const std::vector<std::string>& axes,
                                        const Options& options, MachineConfig& machine) {
  std::map<std::string, Found> found;
  for (const std::string& name : axes) {
    std::cout << "axis " << name << ", in csp first\n" << std::flush;
    const auto watchman = Record(client, machine, PlanFor(machine, Status(client), name, options));
    Found& f = found[name];
    f.job = JobOf(machine, name, *watchman, options);
    f.id = IdentifyUnlessInterrupted(f.job);
    if (const std::string why = identify::WhyNoBeginning(f.id); why.empty())
      machine.axes.at(name).model = identify::ToModel(f.id, f.job.model);
    else
      std::cout << "note: that says too little of axis " << name << ": " << why << "\n";
  }
  return found;
}

/// A stop in torque mode may be the loop's from here, or a fault of the axis that nobody should enable it
/// again with: the drive's own loop is named, and left to who has looked at the axis.
std::string InCspInstead(const MachineConfig& own, const std::string& axis) {
  const std::string set = DriveLeads(own, axis) ? "" : " with --set axes." + axis + ".drive.mode=csp";
  return ". Nothing was written, and nothing is tried again by itself. If the axis is sound (look at it "
         "first), "
         "its drive's own loop can hold it for the record, where the drive has csp: contourd anew" +
         set + ", then contour commission --mode csp";
}

/// Where the machine stays in csp, `torque` says why.
void EnterTorqueMode(TorqueModeStay& stay, const std::map<std::string, ModelConfig>& models,
                     TorqueLoops& torque) {
  try {
    if (!stay.Enter(torque.loops, models))
      torque.why_not = "the drives do not come up in torque mode (0x6502)";
  } catch (const BeginRefused& refused) {
    torque.why_not = std::string("contourd does not take torque mode: ") + refused.what();
  }
}

std::string DescribeAll(const MachineConfig& own, const MachineConfig& recorded, const json& status,
                        const TorqueLoops& torque, const Options& options) {
  std::string text;
  for (const std::string& name : torque.lacking)
    text += "in csp, to know it well enough for a loop in torque mode, " +
            Describe(PlanFor(own, status, name, options));
  if (torque.complete() || !torque.lacking.empty())
    text +=
        "in torque mode, held by loops from here, and back to csp at the end (contourd begins anew each "
        "time), ";
  return text + Describe(PlanFor(recorded, status, options.axis, options));
}

int RunCommission(const Options& options) {
  auto client = std::make_unique<ControlClient>(ConnectToDaemon(options.socket));
  MachineConfig own = AskForMachine(*client);
  CheckBeforehand(own, StatusOnceStarted(*client), options);
  TorqueLoops torque = LoopsToRecordWith(own, Status(*client), options);
  const bool stays_told = torque.loops.empty() && torque.lacking.empty();
  MachineConfig machine = torque.complete() ? InTorqueMode(own, torque.loops) : own;
  std::cout << DescribeAll(own, machine, Status(*client), torque, options);
  if (!options.drive) Advise(machine);
  if (!Confirmed(options)) {
    std::cout << "nothing was moved\n";
    return kExitFailed;
  }
  std::signal(SIGINT, OnSignal);
  std::signal(SIGTERM, OnSignal);
  std::map<std::string, ModelConfig> models;
  std::map<std::string, Found> in_csp;
  if (!torque.lacking.empty()) {
    MachineConfig known = own;
    in_csp = KnowBetter(*client, torque.lacking, options, known);
    for (const auto& [name, found] : in_csp) models[name] = known.axes.at(name).model;
    torque = FindTorqueLoopsUnlessInterrupted(known, torque);
    if (torque.complete()) machine = InTorqueMode(known, torque.loops);
  }
  TorqueModeStay stay(client, options.socket);
  if (torque.complete()) EnterTorqueMode(stay, models, torque);
  if (!torque.complete() && !stays_told) {
    if (options.mode == "cst")
      throw std::runtime_error("no record in torque mode: " + torque.why_not + kCspInstead);
    std::cout << kStays << torque.why_not << "\n";
    machine = own;
  }
  std::optional<Found> found;
  if (!torque.complete() && in_csp.contains(options.axis)) {
    found = std::move(in_csp.at(options.axis));
  } else {
    std::unique_ptr<Watchman> watchman;
    try {
      watchman = Record(*client, machine, PlanFor(machine, Status(*client), options.axis, options));
    } catch (const MachineStopped& stopped) {
      stay.LeaveOrSay();
      if (DriveLeads(machine, options.axis)) throw;
      throw std::runtime_error(stopped.what() + InCspInstead(own, options.axis));
    } catch (const std::exception&) {
      stay.LeaveOrSay();
      throw;
    }
    stay.Leave();
    if (options.drive)
      return ReportOnDrive(machine, options.axis, watchman->drive_samples(),
                           options.out.empty() ? options.axis + "_drive.json" : options.out);
    found.emplace();
    found->job = JobOf(machine, options.axis, *watchman, options);
    found->id = IdentifyUnlessInterrupted(found->job);
  }
  const ModelConfig model = Report(found->job, found->id);
  FindAndWriteLoopUnlessInterrupted(machine, model, options);
  return kExitDone;
}

}  // namespace

void AddCommissionCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
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
                  "Torque at which it stops (default: 60 % of the axis's limit)");
  sub->add_option("--out", options->out, "Model file to write (default: NAME_model.yaml)");
  sub->add_option("--loop", options->loop, "Loop file to write (default: NAME_loop.yaml)");
  sub->add_option("--report", options->report, "Directory of the report (default: NAME_commissioning)");
  sub->add_option(
         "--mode", options->mode,
         "What the drives are in while the axis is recorded, where they run in csp: cst, csp, or auto: "
         "cst where a loop is stable for all that the models leave open")
      ->check(CLI::IsMember({"auto", "cst", "csp"}));
  sub->add_flag(
      "--drive", options->drive,
      "Measure the loop that the drive closes (csp), and what it can do, instead of the axis; --out "
      "is then NAME_drive.json");
  sub->add_flag("--yes", options->yes, "Do not ask before the axis is enabled and moves");
  sub->footer(
      "Enables the machine, runs its motions one after the other, and takes the torque off at the end. An "
      "interrupt (Ctrl-C) stops the axis, takes the torque off and ends with status 1; while it identifies, "
      "at once.");
  sub->callback([options, &action] { action = [options] { return RunCommission(*options); }; });
}

}  // namespace contour
