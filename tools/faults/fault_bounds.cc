#include "tools/faults/fault_bounds.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "config/motion_bounds.h"
#include "config/stopping.h"
#include "drivers/cia402/mode_for.h"

namespace contour::faults {
namespace {

/// Which of the promises of a machine file is about a fault.
enum class Promise : std::uint8_t {
  kNothing,       ///< nothing may come of it: the axis stays within its following error
  kQuickStop,     ///< seen in the cycle in which it comes, then the drive's ramp
  kLadder,        ///< of the cycle's eye on itself, then a stop on the path
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
    case Fault::kBusTraffic:
      return Promise::kNothing;
    case Fault::kFeedbackFramesLost:
    case Fault::kFeedbackFramesLate:
    case Fault::kFloodBurst:
    case Fault::kDriveRestarts:
    case Fault::kGridPointsSkipped:
      return Promise::kFeedbackLost;
    case Fault::kCyclesLate:
      return Promise::kLadder;
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
    case Fault::kScaleSilent:
    case Fault::kScaleFrozen:
    case Fault::kScaleReversed:
    case Fault::kScaleJump:
    case Fault::kScaleCountsLess:
    case Fault::kEncoderCountsLess:
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
/// Feeds of an axis that does not move evenly, in steps of this ratio.
constexpr double kFeedStep = 1.3;
/// Of the lead: what scale and motor are off by before it is a lie; and time besides.
constexpr double kScaleOff_rel = 3e-3;
constexpr double kScaleSeen_s = 0.1;

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

/// What lasts is noticed, softened, fallen back from and stopped, each by an alarm of its own; one that comes
/// sooner than step_s after the one before counts for nothing.
double Ladder_s(const MachineConfig& machine) {
  const SupervisionConfig& s = machine.control.supervision;
  const double alarm_s = 1e-3 * s.late_ms;
  return alarm_s * (1.0 + 3.0 * std::ceil(s.step_s / alarm_s));
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
    case Promise::kLadder:
    case Promise::kPathStop: {
      RunBound bound = Plus(quick, axis);
      bound.time_s = std::max(bound.time_s, Way(machine, "SIGTERM, SIGINT", number).time_s) +
                     (promise == Promise::kLadder ? Ladder_s(machine) : 0.0);
      return bound;
    }
    default:
      return Plus(quick, axis);
  }
}

/// The axis as it is run: the mode of the run is that of all axes.
struct RunMachine {
  MachineConfig machine;
  const AxisConfig& axis;
  RunMachine(const MachineConfig& m, const FaultCase& c) : machine(m), axis(AxisOf(machine, c.axis)) {
    for (auto& [name, a] : machine.axes) a.drive.mode = c.mode;
  }
};

MotionFault MotionFaultOf(Fault fault, double jump_mm, double seen_mm) {
  switch (fault) {
    case Fault::kEncoderFrozen:
      return MotionFault::kFrozen;
    case Fault::kEncoderFlickers:
      return MotionFault::kFlickers;
    case Fault::kEncoderReversed:
      return MotionFault::kReversed;
    case Fault::kEncoderJump:
    case Fault::kEncoderJumpLarge:
      return jump_mm > seen_mm ? MotionFault::kJump : MotionFault::kSmallJump;
    default:
      return MotionFault::kTorqueLost;
  }
}

/// The screw's wind-up under static friction: a table that is where it should be has its motor elsewhere.
double SettledError_m(const AxisConfig& axis) {
  const Mechanics m = ToSi(axis.model.mechanics);
  const Friction f = ToSi(axis.model.friction, m.radius_m_rad);
  return std::max(f.Fs_plus_N, f.Fs_minus_N) / m.stiffness_N_m;
}

/// Feeds that the axis has from the fault on: its own, and those on its way there or to rest.
std::vector<double> FeedsOf(const FaultCase& c) {
  std::vector<double> feeds;
  if (!Moves(c.phase) || c.phase == Phase::kStopping || c.phase == Phase::kResuming) feeds.push_back(0.0);
  if (!Moves(c.phase)) return feeds;
  feeds.push_back(c.feed_mm_s);
  if (c.phase != Phase::kConstant)
    for (double feed = contour::kSlowestFeed_mm_s; feed < c.feed_mm_s; feed *= kFeedStep)
      feeds.push_back(feed);
  return feeds;
}

RunBound MotionBound(const MachineConfig& machine, const FaultCase& c) {
  const RunMachine run(machine, c);
  RunBound bound;
  for (const double feed : FeedsOf(c)) {
    const double seen_mm = BoundOf(run.machine, run.axis, MotionFault::kSmallJump, feed).departure_mm;
    const MotionFault fault = MotionFaultOf(c.fault, JumpSize_mm(machine, c), seen_mm);
    const FaultBound at = BoundOf(run.machine, run.axis, fault, feed);
    bound.departure_m = std::max(bound.departure_m, 1e-3 * at.departure_mm);
    // Slower than its feed the axis is only on the way: the feed itself says how long. After a change of feed
    // it stays slower.
    const bool stays = c.phase == Phase::kFeedChange && feed >= kLeastOfFeed * c.feed_mm_s;
    if (feed == c.feed_mm_s || !Moves(c.phase) || stays) bound.time_s = std::max(bound.time_s, at.time_s);
  }
  // Before the fault the axis may be this far from its path already, and wound up.
  bound.departure_m += SettledError_m(run.axis);
  return bound;
}

/// A scale that stands or counts backwards is seen once it is off by more than a screw can explain.
double ScaleSeen_s(const MachineConfig& machine, const FaultCase& c) {
  const bool slowly = c.fault == Fault::kScaleCountsLess || c.fault == Fault::kEncoderCountsLess;
  if (c.fault != Fault::kScaleFrozen && c.fault != Fault::kScaleReversed && !slowly) return 0.0;
  const AxisConfig& axis = AxisOf(machine, c.axis);
  const double seen_mm = kScaleOff_rel * axis.model.mechanics.lead_mm + 4e3 * SettledError_m(axis);
  return seen_mm / ((slowly ? kCountsMissing_rel : 1.0) * c.feed_mm_s) + kScaleSeen_s;
}

}  // namespace

bool ShownByMotion(Fault fault) { return PromiseOf(fault) == Promise::kMotion; }

bool Crawls(const MachineConfig& machine, const FaultCase& c) {
  const RunMachine run(machine, c);
  return !Moves(c.phase) || c.feed_mm_s < TellingFeed_mm_s(run.machine, run.axis);
}

double JumpSize_mm(const MachineConfig& machine, const FaultCase& c) {
  const double safe_mm = AxisOf(machine, c.axis).limits.safe_travel_mm;
  if (c.fault == Fault::kEncoderJump || c.fault == Fault::kScaleJump) return 0.1 * safe_mm;
  if (c.fault == Fault::kEncoderJumpLarge) return 3.0 * safe_mm;
  return 0.0;
}

bool JumpIsSeen(const MachineConfig& machine, const FaultCase& c) {
  const RunMachine run(machine, c);
  for (const double feed : FeedsOf(c))
    if (JumpSize_mm(machine, c) <= BoundOf(run.machine, run.axis, MotionFault::kSmallJump, feed).departure_mm)
      return false;
  return true;
}

RunBound RunBoundOf(const MachineConfig& machine, const FaultCase& c) {
  const Promise promise = PromiseOf(c.fault);
  if (promise == Promise::kMotion) return MotionBound(machine, c);
  RunBound bound = Bound(machine, promise, c.axis);
  bound.time_s += ScaleSeen_s(machine, c);
  return bound;
}

RunBound BoundOfOthers(const MachineConfig& machine, const FaultCase& c, std::size_t axis) {
  const Promise promise = PromiseOf(c.fault);
  // Others are told to stop when the broken one is; what comes of a silent bus they share.
  RunBound bound = Bound(machine, promise == Promise::kMotion ? Promise::kQuickStop : promise, axis);
  bound.time_s += RunBoundOf(machine, c).time_s;
  // Until it is seen, the stop on the path that had begun goes on.
  if (c.phase == Phase::kStopping)
    bound.time_s = std::max(bound.time_s, Way(machine, "operator stop", axis).time_s);
  return bound;
}

}  // namespace contour::faults
