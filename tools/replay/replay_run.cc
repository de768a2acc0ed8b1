#include "tools/replay/replay_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "config/load_machine.h"
#include "daemon/build_identity.h"
#include "daemon/make_cycle_config.h"
#include "daemon/make_log_header.h"
#include "daemon/rt/cycle.h"
#include "daemon/rt/cycle_parts.h"
#include "daemon/telemetry/log_format.h"
#include "daemon/telemetry/tuning_note.h"
#include "design/loop_choice.h"
#include "drivers/lcm/cycle_messages.h"
#include "tools/replay/output_quantities.h"

namespace contour {
namespace {

/// All that is in the log of what a cycle gave out, as bytes. Whatever the list of quantities might leave
/// out, this does not.
std::string OutputBytes(const CycleOutput& output) {
  CycleEntry entry;
  entry.output = output;
  contour_lcm::cycle_entry message;
  ToMessage(entry, message);
  return Encode(message);
}

class Differences {
 public:
  explicit Differences(const LogHeader& header) : quantities_(header.axis_names) {
    all_.resize(quantities_.names().size());
    for (std::size_t i = 0; i < all_.size(); ++i) all_[i].quantity = quantities_.names()[i];
    other_.quantity = "record";
  }

  void Add(const CycleOutput& recorded, const CycleOutput& replayed) {
    quantities_.Values(recorded, was_);
    for (std::size_t i = 0; i < all_.size(); ++i)
      if (const double* value = std::get_if<double>(&was_[i]); value != nullptr && std::isfinite(*value))
        all_[i].scale = std::max(all_[i].scale, std::abs(*value));
    if (OutputBytes(recorded) == OutputBytes(replayed)) return;
    quantities_.Values(replayed, is_);
    const std::uint64_t cycle = recorded.record.cycle;
    bool named = false;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      if (Identical(was_[i], is_[i])) continue;
      named = true;
      AddTo(all_[i], cycle, was_[i], is_[i]);
    }
    if (!named) AddTo(other_, cycle, std::string("other"), std::string("something else"));
  }

  /// Those that differ, the first first.
  [[nodiscard]] std::vector<QuantityDifference> Found(double tolerance) const {
    std::vector<QuantityDifference> found;
    for (const QuantityDifference& d : all_)
      if (d.cycles != 0) found.push_back(d);
    if (other_.cycles != 0) found.push_back(other_);
    bool frames_follow = tolerance > 0.0;
    for (QuantityDifference& d : found) {
      d.within_tolerance = d.largest && *d.largest <= tolerance * d.scale;
      frames_follow = frames_follow && (d.within_tolerance || d.quantity == "frames");
    }
    // What is sent is the measures, rounded: within their tolerance they may round to the next count.
    for (QuantityDifference& d : found)
      if (d.quantity == "frames") d.within_tolerance = frames_follow;
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.cycle < b.cycle; });
    return found;
  }

 private:
  static void AddTo(QuantityDifference& d, std::uint64_t cycle, const OutputValue& was,
                    const OutputValue& is) {
    if (d.cycles++ == 0) {
      d.cycle = cycle;
      d.recorded = Text(was);
      d.replayed = Text(is);
    }
    const double* a = std::get_if<double>(&was);
    const double* b = std::get_if<double>(&is);
    if (a == nullptr || b == nullptr) return;
    double difference = std::abs(*a - *b);
    if (!std::isfinite(difference)) difference = std::numeric_limits<double>::infinity();
    if (d.largest && *d.largest >= difference) return;
    d.largest = difference;
    d.largest_cycle = cycle;
  }

  OutputQuantities quantities_;
  std::vector<QuantityDifference> all_;
  QuantityDifference other_;
  std::vector<OutputValue> was_;
  std::vector<OutputValue> is_;
};

/// Cycles that ran between the last one and this one and are not in the log.
std::uint64_t MissingBefore(const CycleEntry& entry, std::uint64_t last_cycle) {
  const std::uint64_t gap = entry.input.cycle - last_cycle - 1;
  return gap > entry.timing.skipped_grid_points ? gap - entry.timing.skipped_grid_points : 0;
}

void LoadState(Cycle& cycle, const LogState& state) {
  if (state.build != BuildIdentity())
    throw LogError(
        "the log begins in the middle of a run, with a state that only the build that wrote it can "
        "read: " +
        state.build + "; this is " + BuildIdentity());
  if (!cycle.LoadState(std::as_bytes(std::span(state.bytes))))
    throw LogError("the state at the beginning of the log is not that of its configuration");
}

/// Gains were changed in the run: the same change here, before the same cycle.
void Tune(Cycle& cycle, MachineSource& source, const std::vector<LogNote>& notes, std::uint32_t change) {
  for (const LogNote& note : notes) {
    if (note.key != kTuningNote + std::to_string(change)) continue;
    for (std::string& assignment : Lines(note.text)) source.overrides.push_back(std::move(assignment));
    const MachineConfig machine = LoadMachine(source);
    ContourController next = MakeController(MakeCycleConfig(machine, machine.machine.controller));
    if (cycle.TakeController(next)) return;
  }
  throw LogError("the log does not say what change " + std::to_string(change) + " of the gains was");
}

ReplayVerdict Judge(const std::vector<QuantityDifference>& differences) {
  if (differences.empty()) return ReplayVerdict::kSame;
  const bool within = std::all_of(differences.begin(), differences.end(),
                                  [](const QuantityDifference& d) { return d.within_tolerance; });
  return within ? ReplayVerdict::kWithinTolerance : ReplayVerdict::kDiffers;
}

}  // namespace

std::string_view Name(ReplayVerdict verdict) {
  switch (verdict) {
    case ReplayVerdict::kSame:
      return "same";
    case ReplayVerdict::kWithinTolerance:
      return "within_tolerance";
    case ReplayVerdict::kDiffers:
      return "differs";
    case ReplayVerdict::kDamaged:
      return "damaged";
    case ReplayVerdict::kIncomplete:
      return "incomplete";
    case ReplayVerdict::kNoOutputs:
      return "no_outputs";
    case ReplayVerdict::kCutShort:
      return "cut_short";
  }
  return "unknown";
}

bool Passed(ReplayVerdict verdict) {
  return verdict == ReplayVerdict::kSame || verdict == ReplayVerdict::kWithinTolerance ||
         verdict == ReplayVerdict::kNoOutputs;
}

ReplayReport Replay(LogReader& log, const ReplayOptions& options) {
  MachineSource source = SourceOf(log.header());
  source.overrides.insert(source.overrides.end(), options.set.begin(), options.set.end());
  // Of another controller than the one that ran.
  for (std::string& loop : LoopsThatAreMissing(LoadMachine(source), source.name))
    source.overrides.push_back(std::move(loop));
  const MachineConfig machine = LoadMachine(source);
  CycleConfig config = MakeCycleConfig(machine, machine.machine.controller);
  const std::int32_t format = log.header().format_version;
  if (format < kStartUpNowSinceFormat)
    config.master.start_up =
        format < kStartUpOf6SinceFormat ? StartUp::kOfLogFormat4 : StartUp::kOfLogFormat6;
  Cycle cycle(config);
  ReplayReport report;
  report.recorded_build = log.header().build;
  report.replayed_build = BuildIdentity();
  report.tolerance = options.tolerance;
  Differences differences(log.header());
  const auto recorded = std::make_unique<CycleEntry>();
  const auto replayed = std::make_unique<CycleEntry>();
  bool outputs = true;
  try {
    while (log.Next(*recorded)) {
      const std::uint64_t number = recorded->input.cycle;
      if (report.cycles == 0) {
        if (log.state()) LoadState(cycle, *log.state());
        report.first_cycle = number;
        report.last_cycle = log.state() ? log.state()->cycle : 0;
        outputs = !recorded->output.record.axes.empty();
      }
      if (const std::uint64_t missing = MissingBefore(*recorded, report.last_cycle); missing != 0) {
        report.verdict = ReplayVerdict::kIncomplete;
        report.message = std::to_string(missing) + " cycles are missing after cycle " +
                         std::to_string(report.last_cycle) + "; what comes behind them cannot be computed";
        break;
      }
      replayed->input = recorded->input;
      if (recorded->input.request.kind == RequestKind::kTune &&
          recorded->input.request.program_id != kNothingChanged)
        Tune(cycle, source, log.notes(), recorded->input.request.program_id);
      cycle.Step(replayed->input, replayed->output);
      cycle.TellLate(recorded->timing.late);
      if (outputs) differences.Add(recorded->output, replayed->output);
      if (options.observer) options.observer(*replayed);
      report.last_cycle = number;
      ++report.cycles;
    }
  } catch (const LogError& e) {
    if (!e.damaged_cycle()) throw;
    report.verdict = ReplayVerdict::kDamaged;
    report.damaged_cycle = *e.damaged_cycle();
    report.message = e.what();
  }
  report.closed = log.complete();
  report.differences = differences.Found(options.tolerance);
  if (report.verdict == ReplayVerdict::kSame)
    report.verdict = outputs ? Judge(report.differences) : ReplayVerdict::kNoOutputs;
  // What is missing at the end may be the very thing that the log was written for.
  if (const std::uint64_t missing = log.missing_cycles(); missing != 0 && Passed(report.verdict)) {
    report.verdict = ReplayVerdict::kIncomplete;
    report.message = std::to_string(missing) + " cycles are missing at the end, after cycle " +
                     std::to_string(report.last_cycle);
  }
  if (!report.closed && Passed(report.verdict)) {
    report.verdict = ReplayVerdict::kCutShort;
    report.message = "the log was not closed: its writer was killed, or the file cut short after cycle " +
                     std::to_string(report.last_cycle);
  }
  return report;
}

}  // namespace contour
