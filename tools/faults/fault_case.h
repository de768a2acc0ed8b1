#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/cia402/drive_config.h"
#include "tools/faults/fault.h"
#include "tools/faults/phase.h"

namespace contour::faults {

/// One run of the campaign. Everything else of it follows from these and the campaign's seed.
struct FaultCase {
  Fault fault = Fault::kFeedbackFrameLost;
  Phase phase = Phase::kBringUp;
  DriveMode mode = DriveMode::kCst;
  std::size_t axis = 0;
  std::string axis_name;
  double feed_mm_s = 1.0;  ///< without motion it only tells runs apart
};

/// As --only takes it: fault,phase,mode,axis.
std::string Key(const FaultCase& c);

/// Seed of the one run, the same whichever runs are made besides.
std::uint64_t SeedOf(const FaultCase& c, std::uint64_t campaign_seed);

/// What of the campaign is to be run.
struct PlanRequest {
  std::size_t runs = 3000;
  std::uint64_t seed = 1;
  std::vector<std::string> only;  ///< names of faults, phases, modes and axes; empty: all
  double feed_mm_s = 0.0;         ///< above 0: at this feed alone
  int shard = 0;                  ///< run number i belongs to shard i modulo shards
  int shards = 1;
};

struct PlannedAxis {
  std::string name;
  double velocity_mm_s = 0.0;
};

inline constexpr double kLowestFeed_mm_s = 0.01;
/// Bands of equal ratio from the lowest feed to the axis's limit.
inline constexpr std::size_t kFeedBands = 5;
std::size_t BandOf(double feed_mm_s, double highest_mm_s);

/// All combinations of fault, phase, mode and, in motion, feed band, in an order made by the seed, as often
/// as needed; the feed within its band and the axis are drawn. Throws std::invalid_argument for a name that
/// is none and for a choice that leaves nothing.
std::vector<FaultCase> Plan(const PlanRequest& request, const std::vector<PlannedAxis>& axes);

}  // namespace contour::faults
