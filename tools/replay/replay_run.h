#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/cycle_record.h"
#include "daemon/telemetry/log_reader.h"

namespace contour {

/// A quantity that came out otherwise than it is in the log.
struct QuantityDifference {
  std::string quantity;
  std::uint64_t cycle = 0;  ///< the first at which it differs
  std::string recorded;     ///< there
  std::string replayed;
  std::uint64_t cycles = 0;         ///< at which it differs
  std::optional<double> largest;    ///< absolute difference; none for what is no measure
  std::uint64_t largest_cycle = 0;  ///< where that is
  double scale = 0.0;               ///< largest absolute value in the log
  bool within_tolerance = false;    ///< largest <= tolerance * scale
};

enum class ReplayVerdict {
  kSame,             ///< every output bit for bit
  kWithinTolerance,  ///< not the same bits, but every measure within the tolerance and all else equal
  kDiffers,
  kDamaged,     ///< the file is damaged; what comes before is judged by first_difference
  kIncomplete,  ///< cycles are missing, so that what comes behind cannot be computed
  kNoOutputs,   ///< the log holds inputs only: there is nothing to compare with
  kCutShort,    ///< nothing differs as far as it goes, but the log has no end
};
std::string_view Name(ReplayVerdict verdict);
/// Nothing differs that may not, and nothing is missing.
bool Passed(ReplayVerdict verdict);

struct ReplayReport {
  ReplayVerdict verdict = ReplayVerdict::kSame;
  std::uint64_t cycles = 0;  ///< replayed
  std::uint64_t first_cycle = 0;
  std::uint64_t last_cycle = 0;
  bool closed = false;  ///< the log has its end
  std::string recorded_build;
  std::string replayed_build;
  double tolerance = 0.0;
  std::optional<std::uint64_t> damaged_cycle;
  std::string message;  ///< on damage, missing cycles or a missing end
  /// By the first cycle at which each differs; all of one cycle in the order of OutputQuantities.
  std::vector<QuantityDifference> differences;
};

struct ReplayOptions {
  double tolerance = 0.0;          ///< relative to the largest absolute value of each quantity
  std::vector<std::string> set{};  ///< KEY=VALUE on top of the recorded configuration
  /// Sees every cycle as it came out now.
  std::function<void(const CycleEntry& replayed)> observer{};
};

/// Runs a recorded log through the cycle again, in virtual time. Throws LogError when the log cannot be
/// opened or its state belongs to another build, ConfigError when this build cannot use its configuration.
ReplayReport Replay(LogReader& log, const ReplayOptions& options = {});

}  // namespace contour
