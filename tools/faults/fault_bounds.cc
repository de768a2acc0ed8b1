#include "tools/faults/fault_bounds.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "config/stopping.h"

namespace contour::faults {
namespace {

/// Which of the promises of a machine file is about a fault.
enum class Promise : std::uint8_t {
  kNothing,       ///< nothing may come of it: the axis stays within its following error
  kQuickStop,     ///< seen in the cycle in which it comes, then the drive's ramp
  kPathStop,      ///< at the latest by a stop on the path
  kFeedbackLost,  ///< seen after some cycles without feedback
  kSilence,       ///< the drive does not hear the master any more
  kHeartbeat,     ///< seen when the drive's heartbeat is old
  kMode,          ///< seen when 0x6061 has been asked for, or by statusword bit 12
  kMotion,        ///< seen by what the axis does
};

Promise PromiseOf(Fault fault) {
  switch (fault) {
    case Fault::kFeedbackFrameLost:
    case Fault::kFeedbackFrameLate:
    case Fault::kFeedbackFrameTwice:
    case Fault::kPositionBitLow:
    case Fault::kSetpointLost:
    case Fault::kForeignSdo:
    case Fault::kEmergencyCleared:
    case Fault::kEncoderJumpTiny:
    case Fault::kTorqueHalved:
    case Fault::kLogBlocked:
      return Promise::kNothing;
    case Fault::kFeedbackFramesLost:
    case Fault::kFeedbackFramesLate:
    case Fault::kFloodBurst:
    case Fault::kDriveRestarts:
      return Promise::kFeedbackLost;
    case Fault::kSetpointsLost:
    case Fault::kBusDown:
    case Fault::kFlood:
      return Promise::kSilence;
    case Fault::kHeartbeatsLost:
      return Promise::kHeartbeat;
    case Fault::kDriveWrongMode:
      return Promise::kMode;
    case Fault::kEmergencyTemperature:
    case Fault::kEmergencyCurrent:
    case Fault::kEmergencyVoltage:
    case Fault::kEmergencyEncoder:
    case Fault::kEmergencyLostMaster:
    case Fault::kEmergencyExternal:
    case Fault::kEmergencyMaker:
      return Promise::kPathStop;
    case Fault::kEncoderReversed:
    case Fault::kEncoderJump:
    case Fault::kEncoderJumpLarge:
    case Fault::kEncoderFrozen:
    case Fault::kEncoderFlickers:
    case Fault::kTorqueLost:
    case Fault::kTorqueLostSilently:
      return Promise::kMotion;
    default:
      return Promise::kQuickStop;
  }
}

/// 0x6061 is read once in this time, at the slowest.
constexpr double kModeRead_s = 0.15;
/// Until the machine file has a bound of its own for what motion shows: as long as a following error needs to
/// grow, at most this long.
constexpr double kLongestNotice_s = 3.0;

const AxisConfig& AxisOf(const MachineConfig& machine, std::size_t axis) {
  return std::next(machine.axes.begin(), static_cast<std::ptrdiff_t>(axis))->second;
}

StopBound Way(const MachineConfig& machine, std::string_view name, std::size_t axis) {
  for (const StopWay& way : StopWays(machine))
    if (way.name == name) return way.axes[axis];
  return {};
}

RunBound Plus(const StopBound& stop, const AxisConfig& axis, double seen_s = 0.0) {
  return {1e-3 * (stop.travel_mm + axis.limits.following_error_mm), stop.time_s + seen_s};
}

RunBound Bound(const MachineConfig& machine, Promise promise, std::size_t number) {
  const AxisConfig& axis = AxisOf(machine, number);
  const StopBound quick = Way(machine, "fault (quick stop)", number);
  switch (promise) {
    case Promise::kNothing:
      return {1e-3 * axis.limits.following_error_mm, quick.time_s};
    case Promise::kFeedbackLost:
      return Plus(Way(machine, "feedback lost", number), axis);
    case Promise::kSilence:
      return Plus(Way(machine, "bus lost (interface down)", number), axis);
    case Promise::kHeartbeat:
      return Plus(quick, axis, 1e-3 * (axis.drive.heartbeat_timeout_ms + axis.drive.heartbeat_ms));
    case Promise::kMode:
      return Plus(quick, axis, kModeRead_s);
    case Promise::kPathStop: {
      RunBound bound = Plus(quick, axis);
      bound.time_s = std::max(bound.time_s, Way(machine, "SIGTERM, SIGINT", number).time_s);
      return bound;
    }
    default:
      return Plus(quick, axis);
  }
}

}  // namespace

RunBound RunBoundOf(const MachineConfig& machine, const FaultCase& c) {
  const Promise promise = PromiseOf(c.fault);
  RunBound bound = Bound(machine, promise, c.axis);
  if (promise != Promise::kMotion) return bound;
  const AxisConfig& axis = AxisOf(machine, c.axis);
  bound.departure_m = 1e-3 * axis.limits.safe_travel_mm;
  bound.time_s += std::min(kLongestNotice_s, axis.limits.following_error_mm / std::max(c.feed_mm_s, 1e-6));
  return bound;
}

RunBound BoundOfOthers(const MachineConfig& machine, const FaultCase& c, std::size_t axis) {
  const Promise promise = PromiseOf(c.fault);
  // Others are told to stop when the broken one is; what comes of a silent bus they share.
  RunBound bound = Bound(machine, promise == Promise::kMotion ? Promise::kQuickStop : promise, axis);
  bound.time_s += RunBoundOf(machine, c).time_s;
  return bound;
}

}  // namespace contour::faults
