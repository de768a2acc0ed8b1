#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/metrics/scored_row.h"

namespace contour {

/// What an emulated machine wrote of one SYNC, as far as scoring needs it.
struct TruthSample {
  std::uint64_t sync_number = 0;
  PerAxis<double> table_m;  ///< as the encoder counts: from where an incremental one began to
  PerAxis<double> friction_N;
  PerAxis<double> reported_rad;  ///< encoder
};

/// Encoder angles as the daemon received them, with its own number of the SYNC that latched them.
struct ReceivedAngles {
  std::uint64_t feedback_sync = 0;
  PerAxis<double> angle_rad;
};

/// The truth file of `contour emulate --truth`, found by SYNC number.
class TruthTable {
 public:
  TruthTable(std::vector<TruthSample> samples, std::size_t axes);

  /// Throws std::runtime_error, with the line, when the file cannot be read or lacks a column of an axis.
  static TruthTable Load(const std::filesystem::path& file, std::span<const std::string> axes);

  /// Null when there is no sample of this number.
  [[nodiscard]] const TruthSample* Find(std::uint64_t sync_number) const;

  /// What to add to the daemon's SYNC numbers to get this table's. The two count from their own starts; the
  /// encoder angles, received on one side and reported on the other, say which belong together. Empty when
  /// no single offset explains nearly all of the angles, or when the machine moved too little to tell.
  [[nodiscard]] std::optional<std::int64_t> OffsetOf(std::span<const ReceivedAngles> received) const;

  [[nodiscard]] std::size_t size() const { return samples_.size(); }

 private:
  [[nodiscard]] bool Agrees(const ReceivedAngles& received, std::int64_t offset) const;
  [[nodiscard]] bool Explains(std::span<const ReceivedAngles> received, std::int64_t offset) const;

  std::vector<TruthSample> samples_;
  std::size_t axes_;
};

/// Fills in what the truth knows of a row.
void AddTruth(const TruthSample& truth, ScoredRow& row);

}  // namespace contour
