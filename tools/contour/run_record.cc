#include "tools/contour/run_record.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <utility>

#include "core/controller_name.h"
#include "daemon/telemetry/cycle_csv.h"
#include "drivers/lcm/cycle_messages.h"

namespace contour {
namespace {

/// Half a minute at 1 kHz.
constexpr std::size_t kAlignCycles = 30'000;

/// The emulator hands its truth over a little after the fact.
constexpr int kTruthLooks = 10;
constexpr std::chrono::milliseconds kTruthLookAgain{100};

void AppendNumber(double value, std::string& out) {
  std::array<char, 32> text;
  out.append(text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr);
}

bool EstimatesFriction(const std::string& controller) {
  return controller != Name(ControllerName::kPid) && controller != Name(ControllerName::kCsp) &&
         controller != Name(ControllerName::kCnc) && controller != Name(ControllerName::kMpc);
}

/// cycles.csv: the rows of every table of cycles, then the true friction of an emulated machine.
class CyclesFile {
 public:
  CyclesFile(const std::filesystem::path& file, std::span<const std::string> axes, int cycle_us, bool truth)
      : file_(file), out_(file, std::ios::binary), csv_(axes, cycle_us), truth_(truth) {
    std::string header = csv_.Header();
    header.pop_back();
    for (const std::string& axis : axes)
      if (truth) header += ',' + axis + "_friction_truth_N";
    out_ << header << '\n';
  }

  /// The true position of the table stands in for a linear scale.
  void Add(CycleRecord record, const CycleTiming& timing, const TruthSample* truth) {
    row_.clear();
    for (std::size_t i = 0; truth != nullptr && i < record.axes.size(); ++i) {
      record.axes[i].feedback.has_scale = true;
      record.axes[i].feedback.table_position_m = truth->table_m[i];
    }
    csv_.AppendRow(record, timing, row_);
    row_.pop_back();
    for (std::size_t i = 0; truth_ && i < record.axes.size(); ++i) {
      row_ += ',';
      if (truth != nullptr) AppendNumber(truth->friction_N[i], row_);
    }
    out_ << row_ << '\n';
  }

  void Close() {
    out_.close();
    if (!out_) throw std::runtime_error("cannot write " + file_.string());
  }

 private:
  std::filesystem::path file_;
  std::ofstream out_;
  CycleCsv csv_;
  bool truth_;
  std::string row_;
};

}  // namespace

RunRecord::RunRecord(const std::filesystem::path& directory) : directory_(directory) {
  std::error_code error;
  std::filesystem::create_directories(directory_, error);
  if (error) throw std::runtime_error("cannot make " + directory_.string() + ": " + error.message());
  const std::filesystem::path file = directory_ / "rows.tmp";
  rows_.reset(std::fopen(file.c_str(), "w+b"));
  if (rows_ == nullptr)
    throw std::runtime_error("cannot write " + file.string() + ": " + std::strerror(errno));
  // It lives as long as it is open, and no longer, however this program ends.
  std::filesystem::remove(file, error);
}

void RunRecord::Add(std::string_view row, std::uint32_t program_id) {
  contour_lcm::cycle_entry message{};
  CycleEntry entry;
  if (!Decode(row, message) || !FromMessage(message, entry))
    throw std::runtime_error("contourd sends rows that this program cannot read; are they of one version?");
  const CycleRecord& record = entry.output.record;
  newest_cycle_ = record.cycle;
  if (record.program_id != program_id || record.state != MachineState::kRunning) return;
  const auto size = static_cast<std::uint32_t>(row.size());
  if (std::fwrite(&size, sizeof size, 1, rows_.get()) != 1 ||
      std::fwrite(row.data(), size, 1, rows_.get()) != 1)
    throw std::runtime_error("cannot write to " + directory_.string() + ": " + std::strerror(errno));
  if (angles_.size() < kAlignCycles) {
    ReceivedAngles& angles = angles_.emplace_back();
    angles.feedback_sync = record.feedback_sync;
    for (const AxisRecord& axis : record.axes) angles.angle_rad.push_back(axis.feedback.position_rad);
  }
  if (cycles_ == 0) stale_first_ = record.stale_cycles;
  stale_last_ = record.stale_cycles;
  last_sync_ = record.feedback_sync;
  late_cycles_ += entry.timing.late ? 1 : 0;
  ++cycles_;
}

RunMetrics RunRecord::Write(const Facts& facts, std::shared_ptr<const MotionPlan> plan,
                            const std::optional<std::filesystem::path>& truth_file) {
  if (cycles_ == 0) throw std::runtime_error("no cycle in which the program ran was received");
  std::vector<std::string> names;
  for (const ScoredAxisFacts& axis : facts.axes) names.push_back(axis.name);
  std::optional<AlignedTruth> truth;
  if (truth_file) truth.emplace(Align(*truth_file, names));

  CyclesFile cycles(directory_ / "cycles.csv", names, facts.cycle_us, truth.has_value());
  RunScorer scorer(std::move(plan), facts.axes);
  if (std::fflush(rows_.get()) != 0)
    throw std::runtime_error("cannot write to " + directory_.string() + ": " + std::strerror(errno));
  std::rewind(rows_.get());
  for (CycleEntry entry; ReadBack(entry);) {
    const CycleRecord& record = entry.output.record;
    const auto sync = static_cast<std::int64_t>(record.feedback_sync) + (truth ? truth->offset : 0);
    const TruthSample* sample = truth ? truth->table.Find(static_cast<std::uint64_t>(sync)) : nullptr;
    cycles.Add(record, entry.timing, sample);
    ScoredRow row = RowOf(record, EstimatesFriction(facts.controller));
    if (sample != nullptr) AddTruth(*sample, row);
    scorer.Add(row);
  }
  cycles.Close();

  RunFacts run;
  run.controller = facts.controller;
  run.program = facts.program;
  run.cycle_us = facts.cycle_us;
  run.seed = facts.seed;
  run.cycles = cycles_;
  if (facts.wall_clock) run.late_cycles = late_cycles_;
  run.stale_cycles = stale_last_ - stale_first_;
  RunMetrics metrics = scorer.Finish();
  WriteMetrics(directory_ / "metrics.json", run, metrics);
  return metrics;
}

RunRecord::AlignedTruth RunRecord::Align(const std::filesystem::path& file,
                                         std::span<const std::string> axes) const {
  for (int look = 1;; ++look) {
    TruthTable table = TruthTable::Load(file, axes);
    const auto offset = table.OffsetOf(angles_);
    const bool whole =
        offset &&
        table.Find(static_cast<std::uint64_t>(static_cast<std::int64_t>(last_sync_) + *offset)) != nullptr;
    if (whole || (offset && look == kTruthLooks)) return {std::move(table), *offset};
    if (look == kTruthLooks)
      throw std::runtime_error(file.string() +
                               " does not hold the truth of this run: no place in it fits the angles");
    std::this_thread::sleep_for(kTruthLookAgain);
  }
}

bool RunRecord::ReadBack(CycleEntry& entry) {
  std::uint32_t size = 0;
  if (std::fread(&size, sizeof size, 1, rows_.get()) != 1) return false;
  std::string row(size, '\0');
  contour_lcm::cycle_entry message{};
  if (std::fread(row.data(), size, 1, rows_.get()) != 1 || !Decode(row, message) ||
      !FromMessage(message, entry))
    throw std::runtime_error("cannot read the rows back: " + std::string(std::strerror(errno)));
  return true;
}

}  // namespace contour
