#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/machine_config.h"

// How far an axis can be from the path that was commanded, and how long that takes, until the torque is off
// when its feedback lies or its torque fails. Bounds from the machine file alone, by the same thresholds as
// the cycle's motion monitor: contour check prints them, and refuses a smaller safe_travel_mm.
namespace contour {

enum class MotionFault {
  kFrozen,        ///< the reading stands still
  kFlickers,      ///< the reading stands still but for a count
  kJump,          ///< the reading jumps by more than is seen, and stays displaced
  kSmallJump,     ///< the reading jumps by less: never seen, the axis is displaced by as much
  kReversed,      ///< the reading's sign changes
  kTorqueLost,    ///< the drive gives no torque, whatever it reports
  kNotFollowing,  ///< the drive says so (statusword bit 12, mode of operation, emergency message)
};
inline constexpr MotionFault kMotionFaults[] = {
    MotionFault::kFrozen,   MotionFault::kFlickers,   MotionFault::kJump,        MotionFault::kSmallJump,
    MotionFault::kReversed, MotionFault::kTorqueLost, MotionFault::kNotFollowing};

/// As `contour check` calls it.
std::string_view Name(MotionFault fault);

struct FaultBound {
  /// Of the table from the commanded path, until the torque is off. Infinite: it is not promised to show.
  double departure_mm = 0.0;
  double time_s = 0.0;  ///< from the fault, or from the motion that shows it, until the torque is off
};

/// At this feed of the axis; 0 is at rest.
FaultBound BoundOf(const MachineConfig& config, const AxisConfig& axis, MotionFault fault, double feed_mm_s);

/// Feeds to look at: rest, decades from kSlowestFeed_mm_s on, the axis's highest speed.
inline constexpr double kSlowestFeed_mm_s = 0.01;
std::vector<double> BoundFeeds_mm_s(const AxisConfig& axis);

/// From this feed on the file promises its safe travel: as stated, or where a frozen encoder shows within
/// kShows_s; never below kSlowestFeed_mm_s.
inline constexpr double kShows_s = 0.03;
double PromisedFeed_mm_s(const MachineConfig& config, const AxisConfig& axis);

/// Below this feed an axis that stands shows by its path, before its torque could show what holds it: there
/// lost torque that nothing tells of and an encoder that stands are the same, without a scale.
double TellingFeed_mm_s(const MachineConfig& config, const AxisConfig& axis);

/// The worst of all faults at rest and at feeds from PromisedFeed_mm_s on, and where; without kFlickers,
/// which is told only.
struct WorstDeparture {
  FaultBound bound;
  MotionFault fault = MotionFault::kFrozen;
  double feed_mm_s = 0.0;
};
WorstDeparture WorstDepartureOf(const MachineConfig& config, const AxisConfig& axis);

/// How far the axis coasts from its highest speed once the voltage is off, mm, by what a stated push leaves
/// of Coulomb friction; infinite where it leaves nothing: once it moves, the axis goes on until something
/// else stops it. Drives that close a holding brake then stop sooner.
double CoastTravel_mm(const AxisConfig& axis);

}  // namespace contour
