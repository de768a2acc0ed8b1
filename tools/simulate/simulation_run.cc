#include "tools/simulate/simulation_run.h"

#include <charconv>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>

#include "analysis/metrics/metrics_json.h"
#include "analysis/metrics/run_metrics.h"
#include "daemon/program/motion_plan.h"
#include "daemon/program/path_walk.h"
#include "daemon/telemetry/cycle_csv.h"
#include "tools/simulate/run_log.h"
#include "tools/simulate/virtual_machine.h"

namespace contour {
namespace {

void AppendNumber(double value, std::string& out) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  out.append(text, end);
}

/// cycles.csv: the daemon's row of a cycle, then what the emulated machine really did at the same instant.
class CyclesFile {
 public:
  CyclesFile(const std::filesystem::path& file, std::span<const std::string> axes, int cycle_us)
      : file_(file), stream_(file, std::ios::binary), csv_(axes, cycle_us) {
    std::string header = csv_.Header();
    header.pop_back();
    for (const std::string& a : axes)
      header += "," + a + "_table_position_truth_m," + a + "_friction_truth_N";
    stream_ << header << "\n";
  }

  void Add(const CycleEntry& entry, const TruthRow* truth) {
    row_.clear();
    csv_.AppendRow(entry.output.record, entry.timing, row_);
    row_.pop_back();
    for (std::size_t i = 0; i < entry.output.record.axes.size(); ++i) {
      row_ += ',';
      if (truth != nullptr) AppendNumber(truth->axes[i].TableByEncoder_m(), row_);
      row_ += ',';
      if (truth != nullptr) AppendNumber(truth->axes[i].friction_N, row_);
    }
    row_ += '\n';
    stream_ << row_;
  }

  void Close() {
    stream_.close();
    if (!stream_) throw std::runtime_error("cannot write " + file_.string());
  }

 private:
  std::filesystem::path file_;
  std::ofstream stream_;
  CycleCsv csv_;
  std::string row_;
};

bool EstimatesFriction(ControllerName controller) {
  return controller != ControllerName::kPid && controller != ControllerName::kCsp &&
         controller != ControllerName::kCnc && controller != ControllerName::kMpc;
}

std::vector<ScoredAxisFacts> AxisFacts(const MachineConfig& machine) {
  std::vector<ScoredAxisFacts> facts;
  for (const auto& [name, axis] : machine.axes) {
    const double counts_per_m = axis.drive.encoder_counts_per_rev / (axis.model.mechanics.lead_mm * 1e-3);
    facts.push_back({name, 1.0 / counts_per_m});
  }
  return facts;
}

/// Scores the cycles of the program as they come.
class Scoring {
 public:
  Scoring(const SimulationRequest& request, const VirtualMachine& machine)
      : request_(request), machine_(machine), estimates_(EstimatesFriction(request.controller)) {}

  void Add(const CycleRecord& record, const TruthRow* truth) {
    if (!scorer_) scorer_.emplace(machine_.plan(), AxisFacts(request_.file.machine));
    if (cycles_ == 0) stale_before_ = record.stale_cycles;
    ++cycles_;
    stale_ = record.stale_cycles - stale_before_;
    ScoredRow row = RowOf(record, estimates_);
    for (std::size_t i = 0; truth != nullptr && i < row.axes.size(); ++i) {
      row.axes[i].table_m = truth->axes[i].TableByEncoder_m();
      row.axes[i].friction_truth_N = truth->axes[i].friction_N;
    }
    scorer_->Add(row);
  }

  [[nodiscard]] RunFacts facts() const {
    RunFacts facts;
    facts.controller = Name(request_.controller);
    facts.program = request_.program.name;
    facts.seed = request_.file.emulator.seed;
    facts.cycle_us = request_.file.machine.machine.cycle_us;
    facts.cycles = cycles_;
    facts.stale_cycles = stale_;
    return facts;
  }

  [[nodiscard]] RunMetrics Finish() const {
    if (!scorer_) throw std::runtime_error("no cycle in which the program ran");
    return scorer_->Finish();
  }

 private:
  const SimulationRequest& request_;
  const VirtualMachine& machine_;
  bool estimates_;
  std::optional<RunScorer> scorer_;
  std::uint64_t cycles_ = 0;
  std::uint64_t stale_before_ = 0;
  std::uint64_t stale_ = 0;
};

/// passes.csv: what learning, or a machine that changes, makes of a program from pass to pass.
class PassesFile {
 public:
  void Add(int pass, const RunMetrics& m) {
    text_ += std::to_string(pass);
    for (const ContourMetrics* place : {&m.encoder, &m.table})
      for (const std::optional<double>& value : {place->peak_um, place->rms_um}) {
        text_ += ',';
        if (value) AppendNumber(*value, text_);
      }
    text_ += '\n';
  }
  void Write(const std::filesystem::path& file) const {
    std::ofstream stream(file, std::ios::binary);
    stream << text_;
    stream.close();
    if (!stream) throw std::runtime_error("cannot write " + file.string());
  }

 private:
  std::string text_ = "pass,encoder_peak_um,encoder_rms_um,table_peak_um,table_rms_um\n";
};

/// Asks for the feeds of a pass when it is time for them.
class FeedSchedule {
 public:
  FeedSchedule(const SimulationRequest& request, VirtualMachine& machine)
      : feeds_(request.feeds), machine_(machine), period_s_(1e-6 * request.file.machine.machine.cycle_us) {}

  /// That the pass begins with.
  double Begin() {
    double feed = 1.0;
    for (; next_ < feeds_.size() && feeds_[next_].time_s <= 0.0; ++next_) feed = feeds_[next_].feed;
    return feed;
  }
  /// A cycle in which the program ran.
  void Count() {
    ++cycles_;
    for (; next_ < feeds_.size() && feeds_[next_].time_s <= period_s_ * static_cast<double>(cycles_); ++next_)
      machine_.SetPace(feeds_[next_].feed);
  }

 private:
  const std::vector<FeedFrom>& feeds_;
  VirtualMachine& machine_;
  double period_s_;
  std::size_t next_ = 0;
  std::uint64_t cycles_ = 0;
};

/// The last feed is what the rest of the program runs at, and twice its own is the most that it can have had
/// before.
void RefuseFeedForYears(const std::vector<FeedFrom>& feeds, const MotionPlan& plan, const std::string& name) {
  const double left_s = EstimatedDuration_s(plan) - PathWalk::kLargestScale * feeds.back().time_s;
  if (TakesYears(left_s, feeds.back().feed))
    throw ProgramError(name + ": " + YearsText(100.0 * feeds.back().feed, "the program"));
}

}  // namespace

SimulationResult RunSimulation(const SimulationRequest& request) {
  std::filesystem::create_directories(request.out);
  VirtualMachine machine(request.file, request.controller);
  std::optional<RunLog> log;
  if (!request.log.empty()) {
    log.emplace(request.log, request.log_header);
    machine.SetRecorder([&](const CycleEntry& entry) { log->Add(entry); });
  }
  machine.BringUp();
  machine.Enable();
  machine.SetZero();
  PassesFile passes;
  ProgramTally tally;
  SimulationResult result;
  for (int pass = 1; pass <= request.passes; ++pass) {
    std::optional<CyclesFile> cycles;
    if (pass == request.passes)
      cycles.emplace(request.out / "cycles.csv", machine.axis_names(), request.file.machine.machine.cycle_us);
    Scoring scoring(request, machine);
    FeedSchedule feeds(request, machine);
    machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
      if (entry.output.record.state != MachineState::kRunning) return;
      tally.Consume(entry.output.record);
      if (cycles) cycles->Add(entry, truth);
      scoring.Add(entry.output.record, truth);
      feeds.Count();
    });
    const Program program = request.gcode
                                ? machine.ReadGcode(*request.gcode, request.program.name, request.part)
                                : request.program;
    const auto plan = machine.PlanOf(program);
    if (!request.feeds.empty()) RefuseFeedForYears(request.feeds, *plan, program.name);
    machine.Run(program, plan, feeds.Begin());
    machine.SetObserver(nullptr);
    const RunMetrics metrics = scoring.Finish();
    passes.Add(pass, metrics);
    if (!cycles) continue;
    result = {metrics, tally.tally()};
    cycles->Close();
    WriteMetrics(request.out / "metrics.json", scoring.facts(), metrics);
  }
  if (request.passes > 1) passes.Write(request.out / "passes.csv");
  if (log) log->Close();
  return result;
}

}  // namespace contour
