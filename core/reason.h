#pragma once

#include <cstdint>
#include <string_view>

namespace contour {

/// Why the machine stopped (requests 1.., faults 32..) or what holds an output back (limits 96..).
/// Values are part of the log format: append, never renumber.
enum class Reason : std::uint16_t {
  kNone = 0,
  // What an operator or a program asked for.
  kOperatorStop = 1,
  kTerminate = 2,
  kProgramEnd = 3,
  kDisableRequest = 4,
  // Faults: the machine ends in a defined stop.
  kStaleFeedback = 32,
  kFollowingError = 33,
  kPositionLimit = 34,
  kVelocityLimit = 35,
  kNotANumber = 36,
  kBusDown = 37,
  kBusOff = 38,
  kSendFailed = 39,
  kHeartbeatLost = 40,
  kDriveFault = 41,
  kDriveLeftEnabled = 42,
  kEmergencyStop = 43,
  kEnableChainOpen = 44,
  kIoStale = 45,
  kBringUpFailed = 46,
  kPathUnderrun = 47,
  kPathDiscontinuous = 48,
  kEnableTimeout = 49,
  kStopTimeout = 50,
  kEstimatorDiverged = 51,
  kDriveNotFollowing = 52,
  kGridPointsSkipped = 53,
  kFeedbackFrozen = 54,       ///< the position stands still although torque or path must move it
  kFeedbackJump = 55,         ///< the position went further in a cycle than any force can take it
  kFeedbackReversed = 56,     ///< the position moves against the torque
  kTorqueWithoutMotion = 57,  ///< torque beyond friction and outside forces moves nothing
  kTorqueNotDelivered = 58,   ///< the torque that the drive reports is not the one it was sent
  kScaleDisagrees = 59,       ///< linear scale and motor differ by more than wind-up
  kModeChanged = 60,          ///< 0x6061 is no longer the mode that was set
  kDriveRestarted = 61,
  kDriveLeftOperational = 62,
  kDriveLostMaster = 63,  ///< the drive missed the master's heartbeat, SYNC or RPDO
  kDriveEmergency = 64,   ///< an emergency message that asks for a stop
  kSecondMaster = 65,     ///< frames on the bus that only a master sends, and not ours
  kOscillation = 66,
  kEstimatorInconsistent = 67,  ///< innovations are no longer what the filter says of them
  kSolverCapLasting = 68,
  kCyclesLate = 69,
  kNotReferenced = 70,  ///< the axis does not know where it is: a program is refused
  kScaleLost = 71,      ///< the linear scale in the loop is silent; the axis goes on by its motor, and stops
  kScaleDoubted = 72,   ///< motor and torque contradict the linear scale in the loop; the same
  kDriveStaysEnabled = 73,  ///< the drive is in Operation Enabled although told to leave it
  kNodeAnswersTwice = 74,   ///< more answers to SYNC than SYNCs: two drives have one node number
  kAxisMoves = 75,          ///< the axis is not at rest: it is not enabled
  kAnswersLate = 76,        ///< each answer to SYNC comes a cycle or more late
  // Limits: the output is held back, the machine goes on.
  kTorqueLimit = 96,
  kTorqueRateLimit = 97,
  kSolverCap = 98,
  kInnovationGated = 99,
  kParameterBound = 100,
  kTorqueConstantChanged = 101,
  kOscillationNoticed = 102,
  kSoftened = 103,
  kFallenBack = 104,
  kEmergencyNoticed = 105,
  kForeignSdo = 106,
};

constexpr bool IsFault(Reason r) noexcept {
  const auto v = static_cast<std::uint16_t>(r);
  return v >= 32 && v < 96;
}
/// The reason is of a bus, not of an axis.
constexpr bool IsOfBus(Reason r) noexcept {
  return r == Reason::kBusDown || r == Reason::kBusOff || r == Reason::kSendFailed ||
         r == Reason::kSecondMaster;
}
constexpr bool IsLimit(Reason r) noexcept { return static_cast<std::uint16_t>(r) >= 96; }

/// Short name as it appears in status, logs and cycles.csv.
constexpr std::string_view Name(Reason r) noexcept {
  switch (r) {
    case Reason::kNone:
      return "none";
    case Reason::kOperatorStop:
      return "operator_stop";
    case Reason::kTerminate:
      return "terminate";
    case Reason::kProgramEnd:
      return "program_end";
    case Reason::kDisableRequest:
      return "disable_request";
    case Reason::kStaleFeedback:
      return "stale_feedback";
    case Reason::kFollowingError:
      return "following_error";
    case Reason::kPositionLimit:
      return "position_limit";
    case Reason::kVelocityLimit:
      return "velocity_limit";
    case Reason::kNotANumber:
      return "not_a_number";
    case Reason::kBusDown:
      return "bus_down";
    case Reason::kBusOff:
      return "bus_off";
    case Reason::kSendFailed:
      return "send_failed";
    case Reason::kHeartbeatLost:
      return "heartbeat_lost";
    case Reason::kDriveFault:
      return "drive_fault";
    case Reason::kDriveLeftEnabled:
      return "drive_left_enabled";
    case Reason::kEmergencyStop:
      return "emergency_stop";
    case Reason::kEnableChainOpen:
      return "enable_chain_open";
    case Reason::kIoStale:
      return "io_stale";
    case Reason::kBringUpFailed:
      return "bring_up_failed";
    case Reason::kPathUnderrun:
      return "path_underrun";
    case Reason::kPathDiscontinuous:
      return "path_discontinuous";
    case Reason::kEnableTimeout:
      return "enable_timeout";
    case Reason::kStopTimeout:
      return "stop_timeout";
    case Reason::kEstimatorDiverged:
      return "estimator_diverged";
    case Reason::kDriveNotFollowing:
      return "drive_not_following";
    case Reason::kGridPointsSkipped:
      return "grid_points_skipped";
    case Reason::kTorqueLimit:
      return "torque_limit";
    case Reason::kTorqueRateLimit:
      return "torque_rate_limit";
    case Reason::kSolverCap:
      return "solver_cap";
    case Reason::kInnovationGated:
      return "innovation_gated";
    case Reason::kParameterBound:
      return "parameter_bound";
    case Reason::kFeedbackFrozen:
      return "feedback_frozen";
    case Reason::kFeedbackJump:
      return "feedback_jump";
    case Reason::kFeedbackReversed:
      return "feedback_reversed";
    case Reason::kTorqueWithoutMotion:
      return "torque_without_motion";
    case Reason::kTorqueNotDelivered:
      return "torque_not_delivered";
    case Reason::kScaleDisagrees:
      return "scale_disagrees";
    case Reason::kModeChanged:
      return "mode_changed";
    case Reason::kDriveRestarted:
      return "drive_restarted";
    case Reason::kDriveLeftOperational:
      return "drive_left_operational";
    case Reason::kDriveLostMaster:
      return "drive_lost_master";
    case Reason::kDriveEmergency:
      return "drive_emergency";
    case Reason::kSecondMaster:
      return "second_master";
    case Reason::kOscillation:
      return "oscillation";
    case Reason::kEstimatorInconsistent:
      return "estimator_inconsistent";
    case Reason::kSolverCapLasting:
      return "solver_cap_lasting";
    case Reason::kCyclesLate:
      return "cycles_late";
    case Reason::kNotReferenced:
      return "not_referenced";
    case Reason::kScaleLost:
      return "scale_lost";
    case Reason::kScaleDoubted:
      return "scale_doubted";
    case Reason::kDriveStaysEnabled:
      return "drive_stays_enabled";
    case Reason::kNodeAnswersTwice:
      return "node_answers_twice";
    case Reason::kAxisMoves:
      return "axis_moves";
    case Reason::kAnswersLate:
      return "answers_late";
    case Reason::kTorqueConstantChanged:
      return "torque_constant_changed";
    case Reason::kOscillationNoticed:
      return "oscillation_noticed";
    case Reason::kSoftened:
      return "softened";
    case Reason::kFallenBack:
      return "fallen_back";
    case Reason::kEmergencyNoticed:
      return "emergency_noticed";
    case Reason::kForeignSdo:
      return "foreign_sdo";
  }
  return "unknown";
}

}  // namespace contour
