#include "tools/validation/family/family_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "analysis/metrics/run_metrics.h"
#include "analysis/parallel/parallel_for.h"
#include "config/config_error.h"
#include "daemon/program/program.h"
#include "tools/simulate/virtual_machine.h"

namespace contour {
namespace {

constexpr double kMicro = 1e6;
constexpr const char* kHold = "{shape: hold, seconds: 6}";
constexpr double kHoldScoredFrom_s = 3.0;

/// Distance of the table from the path that was asked for: from the curve through the references around that
/// moment, so that a corner that is to be blended is no error, nor is being late.
class PathScore {
 public:
  void Add(const CycleRecord& record, const MotionPlan& plan, const TruthRow& truth) {
    const double time_s = RowOf(record, false).path_time_s;
    Point reference{}, table{};
    for (std::size_t i = 0; i < kPlane; ++i) {
      reference[i] = record.axes[i].reference.position_m;
      table[i] = truth.axes[i].TableByEncoder_m();
    }
    references_.push_back(reference);
    tables_.push_back(table);
    scored_.push_back(time_s >= 0.0 && plan.Scored(time_s));
  }

  void Finish(FamilyResult& result) const {
    double sum_m2 = 0.0, peak_m = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < tables_.size(); ++i) {
      if (!scored_[i]) continue;
      const double distance_m = Distance_m(i);
      peak_m = std::max(peak_m, distance_m);
      sum_m2 += distance_m * distance_m;
      ++count;
    }
    result.peak_um = kMicro * peak_m;
    result.rms_um = count == 0 ? 0.0 : kMicro * std::sqrt(sum_m2 / static_cast<double>(count));
  }

 private:
  static constexpr std::size_t kPlane = 2;
  using Point = std::array<double, kPlane>;
  /// A path that is followed at all is nearer than this in time.
  static constexpr std::size_t kWindow_cycles = 40;

  [[nodiscard]] static double ToSegment_m2(const Point& p, const Point& a, const Point& b) {
    const double dx = b[0] - a[0], dy = b[1] - a[1], length_m2 = dx * dx + dy * dy;
    const double along =
        length_m2 > 0.0 ? std::clamp(((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length_m2, 0.0, 1.0) : 0.0;
    const double x = p[0] - a[0] - along * dx, y = p[1] - a[1] - along * dy;
    return x * x + y * y;
  }
  [[nodiscard]] double Distance_m(std::size_t i) const {
    const std::size_t from = i < kWindow_cycles ? 0 : i - kWindow_cycles;
    const std::size_t to = std::min(i + kWindow_cycles, references_.size() - 1);
    double nearest_m2 = std::numeric_limits<double>::infinity();
    for (std::size_t j = from; j < to; ++j)
      nearest_m2 = std::min(nearest_m2, ToSegment_m2(tables_[i], references_[j], references_[j + 1]));
    return std::sqrt(nearest_m2);
  }

  std::vector<Point> references_, tables_;
  std::vector<bool> scored_;
};

/// How well an estimate knows by how much it is off.
class BandScore {
 public:
  void Add(double error, double std) {
    error2_ += error * error;
    variance_ += std * std;
    if (std::abs(error) < 2.0 * std) ++inside_;
    ++count_;
  }
  void Finish(double& inside_rel, double& std_over_error) const {
    if (count_ == 0 || variance_ == 0.0) return;
    inside_rel = static_cast<double>(inside_) / static_cast<double>(count_);
    std_over_error = std::sqrt(variance_ / error2_);
  }

 private:
  double error2_ = 0.0, variance_ = 0.0;
  std::size_t inside_ = 0, count_ = 0;
};

class EstimateScore {
 public:
  explicit EstimateScore(const EmulatedMachineFile& file) {
    for (const auto& [name, axis] : file.machine.axes)
      stiffness_N_m_.push_back(kMicro * file.emulator.axes.at(name).screw_stiffness_N_um);
  }
  void Add(const CycleRecord& record, const MotionPlan& plan, const TruthRow& truth) {
    const double time_s = RowOf(record, false).path_time_s;
    if (time_s < 0.0 || !plan.Scored(time_s)) return;
    for (std::size_t i = 0; i < truth.axes.size(); ++i) {
      const AxisEstimate& estimate = record.axes[i].estimate;
      friction_.Add(estimate.friction_N - truth.axes[i].friction_N, estimate.friction_std_N);
      disturbance_.Add(estimate.disturbance_N, estimate.disturbance_std_N);
    }
    last_ = record;
  }
  void Finish(FamilyResult& result) const {
    friction_.Finish(result.friction_inside_rel, result.friction_std_over_error);
    disturbance_.Finish(result.disturbance_inside_rel, result.disturbance_std_over_error);
    if (!last_) return;
    for (std::size_t i = 0; i < stiffness_N_m_.size(); ++i) {
      const AxisEstimate& estimate = last_->axes[i].estimate;
      if (estimate.stiffness_std_N_m == 0.0) continue;
      const double error_N_m = estimate.stiffness_N_m - stiffness_N_m_[i];
      const double stds = std::abs(error_N_m) / estimate.stiffness_std_N_m;
      if (stds < result.stiffness_error_stds) continue;
      result.stiffness_error_stds = stds;
      result.stiffness_error_rel = error_N_m / stiffness_N_m_[i];
      result.stiffness_std_rel = estimate.stiffness_std_N_m / stiffness_N_m_[i];
    }
  }

 private:
  std::vector<double> stiffness_N_m_;
  BandScore friction_, disturbance_;
  std::optional<CycleRecord> last_;
};

/// Largest excursion of the table's axes while the machine holds.
class HoldScore {
 public:
  void Add(const CycleRecord& record, const TruthRow& truth) {
    if (RowOf(record, false).path_time_s < kHoldScoredFrom_s) return;
    lowest_.resize(truth.axes.size(), std::numeric_limits<double>::infinity());
    highest_.resize(truth.axes.size(), -std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < truth.axes.size(); ++i) {
      lowest_[i] = std::min(lowest_[i], truth.axes[i].TableByEncoder_m());
      highest_[i] = std::max(highest_[i], truth.axes[i].TableByEncoder_m());
    }
  }
  [[nodiscard]] double Range_um() const {
    double widest_m = 0.0;
    for (std::size_t i = 0; i < lowest_.size(); ++i) widest_m = std::max(widest_m, highest_[i] - lowest_[i]);
    return kMicro * widest_m;
  }

 private:
  std::vector<double> lowest_, highest_;
};

void RunProgram(VirtualMachine& machine, const EmulatedMachineFile& file, const Program& program,
                FamilyResult& result) {
  PathScore score;
  EstimateScore estimate(file);
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    const CycleRecord& record = entry.output.record;
    if (record.state != MachineState::kRunning || truth == nullptr) return;
    score.Add(record, *machine.plan(), *truth);
    estimate.Add(record, *machine.plan(), *truth);
  });
  try {
    machine.Run(program);
  } catch (const std::exception&) {
    score.Finish(result);
    throw;
  }
  score.Finish(result);
  estimate.Finish(result);
}

void RunHold(VirtualMachine& machine, FamilyResult& result) {
  HoldScore score;
  machine.SetObserver([&](const CycleEntry& entry, const TruthRow* truth) {
    const CycleRecord& record = entry.output.record;
    if (record.state == MachineState::kRunning && truth != nullptr) score.Add(record, *truth);
  });
  machine.Run(ParseProgram(kHold, "hold", ProgramFormat::kYaml));
  result.hold_pp_um = score.Range_um();
}

}  // namespace

EmulatedMachineFile LoadFamilyCell(const std::string& folder, const FamilyCell& cell) {
  FamilySetting setting = cell.setting;
  // Every machine draws the same square: its corners are 3 um inside.
  setting.set.insert(setting.set.begin(), "machine.path_following_mm=0.002");
  setting.set.push_back("axes.*.drive.mode=" + cell.entry.mode);
  setting.set.push_back("machine.controller=" + cell.entry.controller);
  EmulatedMachineFile file =
      LoadEmulatedMachine(folder + "/" + setting.machine + ".yaml", FamilyAssignments(folder, setting));
  file.emulator.seed = cell.seed;
  return file;
}

std::string FamilyProgram(char letter) {
  switch (letter) {
    case 'B':
      return "{shape: circle, radius_mm: 0.1, frequency_hz: 0.7853981634, turns: 5}";
    case 'C':
      return "{shape: circle, radius_mm: 10, feed_mm_min: 3000, turns: 5}";
    case 'S':
      return "{shape: square, side_mm: 10, feed_mm_min: 3000, turns: 5, corner_tolerance_mm: 0.005}";
    default:
      throw ConfigError({std::string("--programs: found '") + letter + "', expected some of B, C, S"});
  }
}

FamilyResult RunFamilyCell(const std::string& folder, const FamilyCell& cell) {
  const Program program =
      ParseProgram(FamilyProgram(cell.program), std::string(1, cell.program), ProgramFormat::kYaml);
  FamilyResult result;
  result.wind_up_um =
      kMicro * WindUp_m(LoadMaybeEmulatedMachine(folder + "/" + cell.setting.machine + ".yaml").emulator);
  std::optional<EmulatedMachineFile> file;
  try {
    file = LoadFamilyCell(folder, cell);
    VirtualMachine machine(*file, file->machine.machine.controller);
    machine.BringUp();
    machine.Enable();
    RunProgram(machine, *file, program, result);
    if (cell.hold) RunHold(machine, result);
  } catch (const std::exception& e) {
    result.failure = e.what();
    result.refused = !file;
  }
  return result;
}

std::vector<FamilyResult> RunFamily(const std::string& folder, const std::vector<FamilyCell>& cells, int jobs,
                                    const std::function<void(std::size_t)>& done) {
  std::vector<FamilyResult> results(cells.size());
  std::mutex mutex;
  std::size_t finished = 0;
  ParallelFor(cells.size(), jobs, [&](std::size_t i) {
    results[i] = RunFamilyCell(folder, cells[i]);
    const std::lock_guard lock(mutex);
    ++finished;
    if (done) done(finished);
  });
  return results;
}

}  // namespace contour
