#include "tools/validation/contest/contest_cell.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>

#include "analysis/metrics/run_metrics.h"
#include "config/config_error.h"
#include "tools/simulate/virtual_machine.h"

namespace contour {
namespace {

constexpr double kWindowsWithoutTurns = 8.0;
constexpr double kGrowthMatters_um = 0.5;
constexpr double kMicro = 1e6;

std::vector<ScoredAxisFacts> AxisFacts(const MachineConfig& machine) {
  std::vector<ScoredAxisFacts> facts;
  for (const auto& [name, axis] : machine.axes)
    facts.push_back({name, axis.model.mechanics.lead_mm * 1e-3 / axis.drive.encoder_counts_per_rev});
  return facts;
}

/// Scores a run and keeps the largest error of each turn.
class CellScore {
 public:
  CellScore(const MotionPlan& plan, RunScorer scorer) : plan_(plan), scorer_(std::move(scorer)) {
    turns_ = plan.Turns(plan.duration_s());
  }

  void Add(const CycleRecord& record, const TruthRow* truth) {
    ScoredRow row = RowOf(record, false);
    if (truth == nullptr) return;
    PerAxis<double> table(row.axes.size());
    for (std::size_t i = 0; i < row.axes.size(); ++i)
      table[i] = row.axes[i].table_m = truth->axes[i].TableByEncoder_m();
    scorer_.Add(row);
    if (row.path_time_s < 0.0 || !plan_.Scored(row.path_time_s)) return;
    const double window = std::floor(WindowAt(row.path_time_s));
    if (window_ != window) {
      window_ = window;
      peaks_um_.push_back(0.0);
    }
    peaks_um_.back() = std::max(peaks_um_.back(), kMicro * plan_.Distance_m(table));
  }

  [[nodiscard]] CellResult Finish() const {
    const RunMetrics metrics = scorer_.Finish();
    CellResult result;
    result.peak_um = metrics.table.peak_um.value_or(0.0);
    result.rms_um = metrics.table.rms_um.value_or(0.0);
    result.encoder_peak_um = metrics.encoder.peak_um.value_or(0.0);
    result.circular_deviation_um = metrics.table.circular_deviation_um;
    result.window_peak_um = peaks_um_;
    return result;
  }

 private:
  /// The last instants, when the turns are complete, belong to the last turn.
  [[nodiscard]] double WindowAt(double time_s) const {
    if (turns_ > 0.0) return std::min(plan_.Turns(time_s), std::max(0.0, std::ceil(turns_ - 1e-6) - 1.0));
    return std::min(kWindowsWithoutTurns * time_s / plan_.duration_s(), kWindowsWithoutTurns - 1.0);
  }

  const MotionPlan& plan_;
  RunScorer scorer_;
  double turns_ = 0.0;
  double window_ = -1.0;
  std::vector<double> peaks_um_;
};

CellResult Run(const ContestCell& cell) {
  EmulatedMachineFile file = *cell.machine;
  file.emulator.seed = cell.seed;
  VirtualMachine machine(file, cell.controller);
  machine.BringUp();
  machine.Enable();
  for (int before = 1; before < cell.passes; ++before) machine.Run(cell.program);
  std::optional<CellScore> score;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    if (entry.output.record.state != MachineState::kRunning) return;
    if (!score) score.emplace(*machine.plan(), RunScorer(machine.plan(), AxisFacts(file.machine)));
    score->Add(entry.output.record, truth);
  });
  machine.Run(cell.program);
  if (!score) throw std::runtime_error("no cycle in which the program ran");
  return score->Finish();
}

}  // namespace

CellResult RunCell(const ContestCell& cell) {
  try {
    return Run(cell);
  } catch (const ConfigError&) {
    throw;  // a program that the machine refuses is a mistake in the contest, not a result
  } catch (const std::exception& e) {
    CellResult failed;
    failed.failure = e.what();
    failed.peak_um = failed.rms_um = failed.encoder_peak_um = std::numeric_limits<double>::infinity();
    return failed;
  }
}

bool Growing(const CellResult& result) {
  const std::vector<double>& peaks = result.window_peak_um;
  if (peaks.size() < 3) return false;
  const std::size_t last = peaks.size() - 1;
  const auto worst = std::max_element(peaks.begin(), peaks.end());
  // A force that comes leaves a turn that is the worst, and others from then on.
  const double after_um = worst + 1 == peaks.end() ? peaks.front() : *(worst + 1);
  return peaks[last] > kGrowthMatters_um && peaks[last] > 2.0 * std::max(peaks.front(), after_um) &&
         peaks[last] > peaks[last - 1] && peaks[last - 1] > peaks[last - 2];
}

}  // namespace contour
