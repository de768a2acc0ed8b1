#include "daemon/supervisor.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "config/config_difference.h"
#include "config/number_text.h"
#include "config/yaml_writer.h"
#include "core/reference.h"
#include "core/version.h"
#include "daemon/drive_warnings.h"
#include "daemon/learning/learnt_under.h"
#include "daemon/loaded_model.h"
#include "daemon/make_cycle_config.h"
#include "daemon/output_words.h"
#include "daemon/program/path_generator.h"
#include "daemon/program/program.h"
#include "daemon/program_limits.h"
#include "daemon/reason_text.h"
#include "daemon/recording_mode.h"
#include "daemon/rt/cycle_parts.h"
#include "daemon/telemetry/tuning_note.h"
#include "drivers/cia301/bring_up_text.h"

namespace contour {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kAnswerTimeout{2};
/// In lock-step a request waits until the machine has settled, for as many cycles as that takes on this host.
constexpr std::chrono::seconds kLockstepAnswerTimeout{25};
constexpr std::chrono::milliseconds kAnswerPoll{1};
/// What the cycle has taken it answers in that cycle, a reset at the end of the drives' quick stops.
constexpr std::chrono::seconds kTakenTimeout{10};
/// A pass that has just ended is with those who learn from it in some milliseconds, or once disk, network and
/// clients that are waited for in lock-step have gone on.
constexpr std::chrono::seconds kPumpTimeout{10};
/// Axes stop within their drives' and the machine's own limits of time, which are shorter.
constexpr std::chrono::seconds kRestTimeout{60};
constexpr const char* kUnwanted =
    "the cycle has not been handed it: whoever asked is gone, or a stop came first";
constexpr const char* kEnding = "contourd is ending";

}  // namespace

Supervisor::Supervisor(const MachineConfig& machine, ControllerName controller, std::string clock,
                       std::vector<std::string> warnings, const SupervisedParts& parts, MachineSource source)
    : machine_(machine),
      source_(std::move(source)),
      machine_name_(machine.machine.name),
      controller_(controller),
      clock_(std::move(clock)),
      cycle_us_(machine.machine.cycle_us),
      warnings_(std::move(warnings)),
      axis_names_(AxisNames(machine)),
      bus_names_(BusNames(machine)),
      limits_(ProgramLimits(machine)),
      parts_(parts),
      answers_(parts.queue.board()),
      pace_(parts.pump),
      events_(UseOfEvents(machine, machine.machine.optional_stop)),
      program_defaults_{machine.machine.optional_stop, machine.machine.block_delete,
                        machine.machine.tool_table, WordsOf(machine)} {
  for (const auto& [name, axis] : machine.axes)
    encoder_counts_m_.push_back(axis.model.mechanics.lead_mm * 1e-3 / axis.drive.encoder_counts_per_rev);
  for (const auto& [name, bus] : machine.buses) interfaces_.push_back(bus.interface);
}

std::string Supervisor::MachineFile() {
  const std::lock_guard lock(reload_);
  return WriteYaml(machine_);
}

std::uint32_t Supervisor::Post(RequestKind kind, std::uint32_t program_id) {
  if (kind == RequestKind::kStop) return parts_.mailbox.PostStop();
  const std::lock_guard lock(posting_);
  return parts_.mailbox.Post(kind, program_id);
}

Answer Supervisor::Ask(RequestKind kind, const std::stop_token& unwanted, std::uint32_t program_id) {
  if (unwanted.stop_requested()) return {false, kUnwanted};
  const std::uint32_t sequence = Post(kind, program_id);
  if (sequence == 0)
    return {false, "the cycle takes no requests: the mailbox is full; is the loop running?", 0, 0};
  return Await(kind, sequence, unwanted);
}

/// The answer, if there is one.
std::optional<Answer> Supervisor::Look(RequestKind kind, std::uint32_t sequence) {
  if (const std::optional<CycleRecord> answer = answers_.answer(sequence)) {
    const bool ok = answer->acknowledged_ok;
    return Answer{ok, ok ? std::string() : RefusalText(*answer, kind, axis_names_, bus_names_), sequence};
  }
  // A stop before the cycle has taken the one before it stands for both.
  if (kind == RequestKind::kStop && answers_.record().acknowledged > sequence)
    return Answer{true, std::string(), sequence};
  if (kind != RequestKind::kStop && parts_.mailbox.Fate(sequence) == RequestFate::kVoid)
    return Answer{false, "it has not been carried out: a stop came first", sequence};
  return std::nullopt;
}

Answer Supervisor::Await(RequestKind kind, std::uint32_t sequence, const std::stop_token& unwanted) {
  const bool stays = kind == RequestKind::kStop || kind == RequestKind::kDisable;
  const auto timeout = clock_ == "lockstep" ? kLockstepAnswerTimeout : kAnswerTimeout;
  const auto deadline = Clock::now() + timeout;
  const auto last = deadline + kTakenTimeout;
  for (;;) {
    const bool ended = loop_ended_;  // before the look: the last cycle's answers are on the board then
    if (std::optional<Answer> answer = Look(kind, sequence)) return *std::move(answer);
    if (ended) return {false, kEnding, sequence};
    const auto now = Clock::now();
    if (stays && now >= deadline)
      return {false,
              "the cycle did not answer within " + std::to_string(timeout.count()) +
                  " s; is the loop running? It is carried out as soon as that runs again",
              sequence};
    // Either the cycle carries it out and answers, or neither: one exchange decides. So nobody is told that
    // something failed which happens later.
    if (!stays && unwanted.stop_requested() && parts_.mailbox.Withdraw(sequence))
      return {false, kUnwanted, sequence};
    if (!stays && now >= deadline && parts_.mailbox.Withdraw(sequence))
      return {false,
              "the cycle did not answer within " + std::to_string(timeout.count()) +
                  " s; is the loop running? The request is withdrawn",
              sequence};
    if (now >= last) {
      TakeBack(kind);
      return {false, "the cycle took the request and did not answer; look at the status", sequence};
    }
    std::this_thread::sleep_for(kAnswerPoll);
  }
}

// The loop died over it. Should it come to life again, the answer that was given becomes true.
void Supervisor::TakeBack(RequestKind kind) {
  if (kind == RequestKind::kEnable) Post(RequestKind::kDisable);
  if (kind == RequestKind::kRun) Post(RequestKind::kStop);
}

Answer Supervisor::Enable(const std::stop_token& unwanted) { return Ask(RequestKind::kEnable, unwanted); }
Answer Supervisor::Disable() { return Ask(RequestKind::kDisable, {}); }
Answer Supervisor::Stop() { return Ask(RequestKind::kStop, {}); }
Answer Supervisor::Reset(const std::stop_token& unwanted) { return Ask(RequestKind::kReset, unwanted); }

Answer Supervisor::Reference(const std::map<std::string, double>& position_mm,
                             const std::stop_token& unwanted) {
  std::vector<std::uint32_t> codes;
  std::string told;
  for (const auto& [name, at_mm] : position_mm) {
    const auto found = std::find(axis_names_.begin(), axis_names_.end(), name);
    if (found == axis_names_.end()) return {false, "there is no axis " + name + " on this machine"};
    const auto index = static_cast<std::size_t>(found - axis_names_.begin());
    const CycleRecord now = answers_.record();
    const bool believed =
        index >= now.axes.size() || now.axes[index].reference_state == ReferenceState::kAbsolute;
    if (machine_.axes.at(name).drive.absolute_encoder && believed)
      return {false,
              "axis " + name +
                  " has an absolute encoder (drive.absolute_encoder): it knows where it is, and is set up "
                  "in its drive"};
    const auto code = Encode({static_cast<std::uint8_t>(index), 1e-3 * at_mm});
    // Where a stop may have left it beyond its limits: from there it is driven back.
    const AxisLimits& limits = machine_.axes.at(name).limits;
    const double least_mm = limits.position_mm[0] - limits.safe_travel_mm,
                 most_mm = limits.position_mm[1] + limits.safe_travel_mm;
    if (!code || at_mm < least_mm || at_mm > most_mm)
      return {false, "axis " + name + " cannot be at " + RoundedText(at_mm) +
                         " mm: limits.position_mm, with safe_travel_mm, is " + RoundedText(least_mm) +
                         " to " + RoundedText(most_mm)};
    codes.push_back(*code);
    told += (told.empty() ? "" : ", ") + name + " at " + RoundedText(at_mm) + " mm";
  }
  if (codes.empty()) return {false, "no axis was named"};
  Answer answer;
  for (const std::uint32_t code : codes) {
    answer = Ask(RequestKind::kReference, unwanted, code);
    if (!answer.accepted) return answer;
    zero_.Lose("an axis was told where it is");
  }
  spdlog::info("told where the axes are: {}", told);
  return answer;
}

Answer Supervisor::Reload() {
  const std::lock_guard lock(reload_);
  try {
    const MachineConfig wanted = LoadMachine(ReadSource(source_.name, source_.overrides));
    const std::vector<ConfigDifference> differences = Differences(machine_, wanted);
    if (differences.empty()) return {true, "nothing has changed"};
    std::string changes, refused;
    for (const ConfigDifference& d : differences) {
      if (MayChangeWhileRunning(d.key)) {
        changes += d.key + "=" + d.now + "\n";
      } else {
        refused += "\n  " + d.key + ": " + d.was + " in use, " + d.now + " in the file";
      }
    }
    if (!refused.empty())
      return {false,
              "nothing was changed: only gains of the controllers may change while contourd runs; restart "
              "it for the rest:" +
                  refused};
    if (parts_.checks.reload) parts_.checks.reload();
    controllers_.push_back(
        std::make_unique<ContourController>(MakeController(MakeCycleConfig(wanted, controller_))));
    parts_.hub.Note(kTuningNote + std::to_string(++changes_), changes);
    const auto post = [&] {
      const std::lock_guard posting(posting_);
      return parts_.mailbox.PostTune(*controllers_.back(), changes_);
    };
    const std::uint32_t sequence = post();
    if (sequence == 0)
      return {false, "the cycle takes no requests: the mailbox is full; is the loop running?"};
    Answer answer = Await(RequestKind::kTune, sequence, {});
    if (!answer.accepted) return answer;  // the new controller stays: the cycle may be about to take it
    controllers_.clear();
    machine_ = wanted;
    parts_.learning.Forget();  // other gains err otherwise
    answer.reason = std::to_string(differences.size()) + " keys changed: " + changes;
    answer.reason.pop_back();
    return answer;
  } catch (const std::exception& e) {
    return {false, e.what()};
  }
}

Answer Supervisor::LoadModel(const std::string& axis, const std::string& yaml) {
  const std::lock_guard lock(reload_);
  if (std::find(axis_names_.begin(), axis_names_.end(), axis) == axis_names_.end())
    return {false, "there is no axis " + axis + " on this machine"};
  const std::string model = axis + "=" + yaml;
  std::vector<std::string> overrides = WithoutModelOf(axis, source_.overrides);
  if (!yaml.empty()) overrides.push_back(ModelOverride(model));
  return BeginAnew(overrides, {model, {}});
}

Answer Supervisor::ChangeMode(const std::map<std::string, std::string>& loops,
                              const std::map<std::string, std::string>& models) {
  const std::lock_guard lock(reload_);
  for (const auto* named : {&loops, &models})
    for (const auto& [axis, yaml] : *named)
      if (std::find(axis_names_.begin(), axis_names_.end(), axis) == axis_names_.end())
        return {false, "there is no axis " + axis + " on this machine"};
  // One mode for all.
  if (!loops.empty() && loops.size() != axis_names_.size())
    return {false, "torque mode needs a loop for every axis"};
  if (!loops.empty() && controller_ != ControllerName::kFull)
    return {false, "in torque mode only the controller full goes by loops, and this is " +
                       std::string(Name(controller_))};
  try {
    RecordingMode mode;
    for (const auto& [axis, yaml] : loops) mode.loops.push_back(axis + "=" + yaml);
    for (const auto& [axis, yaml] : models) mode.models.push_back(axis + "=" + yaml);
    return BeginAnewIn(std::move(mode));
  } catch (const std::exception& e) {
    return {false, e.what()};
  }
}

Answer Supervisor::LeaveToDrives() {
  const std::lock_guard lock(reload_);
  if (controller_ != ControllerName::kFull)
    return {false, "only the controller full works in csp and in torque mode, and this is " +
                       std::string(Name(controller_))};
  try {
    return BeginAnewIn({{}, {}, axis_names_});
  } catch (const std::exception& e) {
    return {false, e.what()};
  }
}

void Supervisor::Abandoned() {
  spdlog::warn("who attended the machine is gone: its torque goes off, after a stop on the path");
  // All that it asked for has been answered by now: an enable that came behind its disable is taken back.
  static_cast<void>(Disable());
  if (!RecordingModeText(parts_.recording_mode)) return;
  const auto deadline = Clock::now() + kRestTimeout;
  MachineState state = answers_.record().state;
  for (; state != MachineState::kIdle; state = answers_.record().state) {
    if (loop_ended_) return;
    if (state == MachineState::kFaulted || Clock::now() >= deadline) break;
    std::this_thread::sleep_for(kAnswerPoll);
  }
  // A fault is for whoever looks at it, in the mode that it came in.
  const Answer answer = state == MachineState::kIdle
                            ? ChangeMode({}, {})
                            : Answer{false, "the machine is " + std::string(Name(state))};
  if (!answer.accepted)
    spdlog::warn("the mode for commissioning stays until contourd is started anew: {}", answer.reason);
}

/// Holding reload_.
Answer Supervisor::BeginAnewIn(RecordingMode mode) {
  std::vector<std::string> overrides = WithoutRecordingMode(parts_.recording_mode, source_.overrides);
  for (const std::string& assignment : RecordingOverrides(mode)) overrides.push_back(assignment);
  return BeginAnew(overrides, {{}, std::move(mode)});
}

/// Holding reload_.
Answer Supervisor::BeginAnew(const std::vector<std::string>& overrides, NewStart start) {
  if (wanted()) return {false, "contourd is about to begin anew"};
  const auto busy = [this]() -> std::optional<Answer> {
    const CycleRecord now = answers_.record();
    if (now.state == MachineState::kIdle) return std::nullopt;
    return Answer{
        false, "contourd begins anew while the machine is Idle, and it is " + std::string(Name(now.state))};
  };
  if (std::optional<Answer> refused = busy()) return *std::move(refused);
  try {
    MakeCycleConfig(LoadMachine(ReadSource(source_.name, overrides)), controller_);
    if (parts_.checks.begin_anew) parts_.checks.begin_anew(start);
    // The checks may have taken seconds.
    if (std::optional<Answer> refused = busy()) return *std::move(refused);
    const std::lock_guard lock(wanting_);
    wanted_ = std::move(start);
    return {true, ""};
  } catch (const std::exception& e) {
    return {false, e.what()};
  }
}

std::optional<NewStart> Supervisor::wanted() {
  const std::lock_guard lock(wanting_);
  return wanted_;
}

Answer Supervisor::Run(const ProgramUpload& upload, const std::stop_token& unwanted) {
  if (!upload.controller.empty() && upload.controller != Name(controller_)) {
    return {false,
            "this daemon runs controller " + std::string(Name(controller_)) +
                "; start it with --controller " + upload.controller + " to run that one",
            0, 0};
  }
  const CycleRecord now = answers_.record();
  if (now.state != MachineState::kReady)
    return {false, RefusalText(now, RequestKind::kRun, axis_names_, bus_names_), 0, 0};
  try {
    const ProgramZero::Found found = zero_.ForProgram(now, upload.from_here);
    if (!found.place) return {false, found.refused};
    const PerAxis<PlanLimits> limits = LimitsNow(limits_, now);
    PartOfProgram part = upload.part;
    part.optional_stop = part.optional_stop.value_or(program_defaults_.optional_stop);
    part.block_delete = part.block_delete.value_or(program_defaults_.block_delete);
    part.tool_table = program_defaults_.tool_table;
    EventUse events = events_;
    events.optional_stop = *part.optional_stop;
    const bool referenced = std::all_of(now.axes.begin(), now.axes.end(),
                                        [](const AxisRecord& a) { return IsReferenced(a.reference_state); });
    const Program program = ReadPlaced(
        {upload.text, upload.name, upload.format == "ngc" ? ProgramFormat::kGcode : ProgramFormat::kYaml},
        *found.place, limits, {referenced, part, events});
    auto generator = std::make_unique<PathGenerator>(PlanPlaced(program, *found.place, limits), limits,
                                                     cycle_us_ * 1e-6, ++program_id_);
    pace_.RefuseYears(upload.name, EstimatedDuration_s(*generator->plan()));
    const bool shown = !parts_.learning.learns() || parts_.pump.AwaitShown(now.cycle, kPumpTimeout, unwanted);
    // Planning and the wait take their time; nothing is learnt, noted or supplied for nobody.
    if (unwanted.stop_requested()) return {false, kUnwanted};
    if (!shown)
      return {
          false,
          "the end of the last pass has not reached those who learn from it within " +
              std::to_string(kPumpTimeout.count()) +
              " s: the host is overloaded, or disk, network or a client holds telemetry up. Run it again"};
    const LearningReport learnt = Learn(upload, *found.place, *generator);
    parts_.hub.Note("program " + std::to_string(program_id_) + " " + upload.name, upload.text);
    // The points wait in the queue until the cycle has taken the request and expects them.
    // In lock-step time waits for the points, so nothing needs to slow down.
    const auto planning = clock_ == "lockstep" ? PacedPath::Options::Planning::kAhead
                                               : PacedPath::Options::Planning::kAheadOrSlower;
    const auto* gcode = std::get_if<GcodeMoves>(&program.shape);
    pace_.Begin(upload.name, std::move(generator),
                PacedPath::Options{.single_block = upload.part.single_block, .planning = planning},
                gcode != nullptr ? HaltsOf(*gcode) : std::vector<ProgramHalt>());
    Answer answer = [&] {
      // Whatever becomes of the request, what is set from then on is no longer for a program that begins.
      const struct End {
        PaceControl& pace;
        ~End() { pace.Begun(); }
      } end{pace_};
      return Ask(RequestKind::kRun, unwanted, program_id_);
    }();
    answer.program_id = program_id_;
    answer.start_m = found.place->start_m;
    answer.zero_m = found.place->zero_m;
    answer.zero_set = found.set_now;
    answer.learnt_passes = learnt.passes;
    answer.best_peak_um = learnt.best_peak_um;
    if (answer.accepted) answer.reason = pace_.Note();
    if (!answer.accepted) {
      parts_.pump.Abandon();
      return answer;
    }
    if (found.set_now) zero_.Set(now);
    const std::lock_guard lock(program_);
    program_name_ = upload.name;
    return answer;
  } catch (const std::exception& e) {
    return {false, e.what(), 0, 0};
  }
}

LearningReport Supervisor::Learn(const ProgramUpload& upload, const Placement& place,
                                 PathGenerator& generator) {
  if (upload.forget) parts_.learning.Forget();
  const auto text = [&] { return LearntUnder(upload.text, place, program_defaults_.tool_table); };
  const LearningReport report =
      parts_.learning.Prepare(text, place.zero_m, program_id_, generator).value_or(LearningReport());
  if (!report.refused.empty()) spdlog::warn("the last pass taught nothing: {}", report.refused);
  if (report.passes > 0)
    spdlog::info("{}: passes learnt from: {}; largest error seen by the scales {:.2f} um, best {:.2f} um",
                 upload.name, report.passes, report.last_peak_um, report.best_peak_um);
  return report;
}

Answer Supervisor::Zero() {
  const CycleRecord now = answers_.record();
  if (now.state != MachineState::kReady && now.state != MachineState::kIdle)
    return {false, "the machine is " + std::string(Name(now.state)) +
                       "; program zero is set where it stands, in Ready or Idle"};
  zero_.Set(now);
  spdlog::info("program zero is where the machine stands");
  return {true, {}};
}

MachineStatus Supervisor::Status() {
  const TelemetryHub::Snapshot s = parts_.hub.snapshot();
  MachineStatus out;
  out.machine = machine_name_;
  out.version = kVersion;
  out.controller = Name(controller_);
  out.clock = clock_;
  out.cycle_us = cycle_us_;
  out.emulator_seed = parts_.emulator_seed;
  out.axis_names = axis_names_;
  const PerAxis<PlanLimits> limits = LimitsNow(limits_, s.record);
  for (std::size_t a = 0; a < axis_names_.size(); ++a)
    out.axis_facts.push_back({limits[a], encoder_counts_m_[a]});
  out.foreign = s.foreign;
  out.warnings = warnings_;
  if (parts_.rest_swing != nullptr)
    for (std::string& warning : parts_.rest_swing->warnings()) out.warnings.push_back(std::move(warning));
  out.record = answers_.record();
  for (std::string& warning : DriveWarnings(out.record, axis_names_))
    out.warnings.push_back(std::move(warning));
  out.bring_up = BringUpText(out.record.bring_up, axis_names_);
  out.reason_text = out.record.reason == Reason::kBringUpFailed
                        ? out.bring_up
                        : ReasonText(out.record, axis_names_, bus_names_);
  if (const std::string failure = parts_.pump.program_failure();
      !failure.empty() &&
      (out.record.reason == Reason::kOperatorStop || out.record.reason == Reason::kPathUnderrun))
    out.reason_text = failure + "; the program was stopped on its path";
  {
    const std::lock_guard lock(program_);
    out.program_name = program_name_;
  }
  out.program_defaults = program_defaults_;
  const PathWalk::Estimate duration = parts_.pump.program_duration();
  out.program_duration_s = duration.duration_s;
  out.program_duration_estimated = !duration.exact;
  out.program_time_share = parts_.pump.program_time_share();
  out.pace = pace_.Status(out.record);
  if (const TallyOfProgram tally = parts_.pump.tally(); tally.program_id == out.record.program_id) {
    out.program_ran_s = static_cast<double>(tally.cycles) * cycle_us_ * 1e-6;
    out.contour_error_peak_m = tally.contour_error_peak_m;
    out.contour_error_rms_m = tally.contour_error_rms_m;
  }
  out.zero_m = zero_.zero_m();
  out.cycles = parts_.loop.counters().cycles.load();
  if (clock_ == "wall") out.late_cycles = parts_.loop.counters().late_cycles.load();
  out.skipped_grid_points = parts_.loop.counters().skipped_grid_points.load();
  out.health = s.health;
  out.drive_errors = s.drive_errors;
  out.dropped_entries = parts_.queue.dropped();
  for (std::size_t b = 0; b < bus_names_.size(); ++b)
    out.buses.push_back({bus_names_[b], interfaces_[b], parts_.loop.bus_states().Read(b)});
  if (parts_.io != nullptr) out.io = parts_.io->stats();
  out.publisher = s.publisher;
  out.log = s.log;
  out.flight = s.flight;
  return out;
}

void Supervisor::Attach(std::shared_ptr<RowFeed> feed) { parts_.hub.Attach(std::move(feed)); }
void Supervisor::Detach(const std::shared_ptr<RowFeed>& feed) { parts_.hub.Detach(feed); }

}  // namespace contour
