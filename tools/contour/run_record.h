#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/metrics/metrics_json.h"
#include "analysis/metrics/run_metrics.h"
#include "analysis/metrics/truth_table.h"
#include "core/cycle_record.h"
#include "daemon/program/motion_plan.h"

namespace contour {

/// What `contour run --out` keeps of a program: the rows of its cycles, in a temporary file until the end,
/// and from them cycles.csv and metrics.json.
class RunRecord {
 public:
  /// `directory` is made when missing. Throws std::runtime_error.
  explicit RunRecord(const std::filesystem::path& directory);

  /// A row as the control socket carries it. Only cycles in which this program ran are kept.
  void Add(std::string_view row, std::uint32_t program_id);

  [[nodiscard]] std::uint64_t cycles() const { return cycles_; }
  /// Newest cycle seen, kept or not.
  [[nodiscard]] std::uint64_t newest_cycle() const { return newest_cycle_; }

  struct Facts {
    std::string controller;
    std::string program;
    int cycle_us = 1000;
    bool wall_clock = true;
    std::optional<std::uint64_t> seed;  ///< of an emulated machine in the daemon
    std::vector<ScoredAxisFacts> axes;
  };
  /// Writes both files; what is in metrics.json. Throws std::runtime_error, also when the truth does not
  /// belong to this run.
  RunMetrics Write(const Facts& facts, std::shared_ptr<const MotionPlan> plan,
                   const std::optional<std::filesystem::path>& truth_file);

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  /// The truth and how its SYNC numbers differ from the daemon's.
  struct AlignedTruth {
    TruthTable table;
    std::int64_t offset;
  };
  [[nodiscard]] AlignedTruth Align(const std::filesystem::path& file,
                                   std::span<const std::string> axes) const;
  bool ReadBack(CycleEntry& entry);

  std::filesystem::path directory_;
  std::unique_ptr<std::FILE, Close> rows_;
  std::vector<ReceivedAngles> angles_;  ///< of the first cycles, enough to align a truth with
  std::uint64_t cycles_ = 0;
  std::uint64_t late_cycles_ = 0;
  std::uint64_t stale_first_ = 0;
  std::uint64_t stale_last_ = 0;
  std::uint64_t newest_cycle_ = 0;
  std::uint64_t last_sync_ = 0;
};

}  // namespace contour
