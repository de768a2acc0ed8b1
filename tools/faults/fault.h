#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace contour::faults {

/// What the campaign breaks. The names are those of the table, of --only and of expected_reasons.cc.
enum class Fault : std::uint8_t {
  // Frames on their way between the cycle and the bus.
  kFeedbackFrameLost,
  kFeedbackFramesLost,
  kFeedbackFrameLate,
  kFeedbackFramesLate,
  kFeedbackFrameTwice,
  kPositionBitLow,
  kPositionBitHigh,
  kStatusBitEnabled,
  kStatusBitFault,
  kSetpointLost,
  kSetpointsLost,
  kHeartbeatsLost,
  kBusDown,
  // Others on the bus.
  kFloodBurst,
  kFlood,
  kForeignReset,
  kForeignSync,
  kForeignNmt,
  kForeignSetpoint,
  kForeignHeartbeat,
  kForeignSdo,
  // The drive.
  kDriveRestarts,
  kDriveLeavesOperational,
  kDriveDropsOut,
  kDriveWrongMode,
  kDriveFault,
  kEmergencyTemperature,
  kEmergencyCurrent,
  kEmergencyVoltage,
  kEmergencyEncoder,
  kEmergencyLostMaster,
  kEmergencyExternal,
  kEmergencyMaker,
  kEmergencyCleared,
  // Encoder and motor.
  kEncoderReversed,
  kEncoderJumpTiny,
  kEncoderJump,
  kEncoderJumpLarge,
  kEncoderFrozen,
  kEncoderFlickers,
  kTorqueLost,
  kTorqueLostSilently,
  kTorqueHalved,
  // The computer.
  kLogBlocked,
  kBusTraffic,
  kGridPointsSkipped,
  kCyclesLate,
  kPositionBitTop,
  // The linear scale, on machines that have one.
  kScaleSilent,
  kScaleFrozen,
  kScaleReversed,
  kScaleJump,
  kScaleCountsLess,
  kEncoderCountsLess,
};

struct FaultName {
  Fault fault;
  std::string_view name;
  std::string_view what;
};

inline constexpr std::array kFaults{
    FaultName{Fault::kFeedbackFrameLost, "feedback_frame_lost", "one answer to SYNC is lost"},
    FaultName{Fault::kFeedbackFramesLost, "feedback_frames_lost", "all answers of a drive are lost"},
    FaultName{Fault::kFeedbackFrameLate, "feedback_frame_late", "one answer comes a cycle late"},
    FaultName{Fault::kFeedbackFramesLate, "feedback_frames_late",
              "all answers of a drive come five cycles late"},
    FaultName{Fault::kFeedbackFrameTwice, "feedback_frame_twice", "one answer comes twice"},
    FaultName{Fault::kPositionBitLow, "position_bit_low",
              "one of the three lowest bits of a position is flipped"},
    FaultName{Fault::kPositionBitHigh, "position_bit_high", "a higher bit of one position is flipped"},
    FaultName{Fault::kStatusBitEnabled, "status_bit_enabled", "one statusword says not Operation Enabled"},
    FaultName{Fault::kStatusBitFault, "status_bit_fault", "one statusword says fault"},
    FaultName{Fault::kSetpointLost, "setpoint_lost", "one set-point is lost"},
    FaultName{Fault::kSetpointsLost, "setpoints_lost", "all set-points of a drive are lost"},
    FaultName{Fault::kHeartbeatsLost, "heartbeats_lost",
              "the heartbeats of a drive are lost, its feedback goes on"},
    FaultName{Fault::kBusDown, "bus_down", "the interface goes down"},
    FaultName{Fault::kFloodBurst, "flood_burst", "a millisecond full of foreign frames of high priority"},
    FaultName{Fault::kFlood, "flood", "foreign frames of high priority leave no room"},
    FaultName{Fault::kForeignReset, "foreign_reset", "another master resets the node"},
    FaultName{Fault::kForeignSync, "foreign_sync", "another master sends SYNC"},
    FaultName{Fault::kForeignNmt, "foreign_nmt", "another master starts all nodes"},
    FaultName{Fault::kForeignSetpoint, "foreign_setpoint", "another master sends the drive set-points"},
    FaultName{Fault::kForeignHeartbeat, "foreign_heartbeat",
              "another master sends heartbeats of our node id"},
    FaultName{Fault::kForeignSdo, "foreign_sdo", "a vendor's tool reads an object beside us"},
    FaultName{Fault::kDriveRestarts, "drive_restarts", "the drive is switched off and on"},
    FaultName{Fault::kDriveLeavesOperational, "drive_leaves_operational",
              "the drive goes to Pre-operational"},
    FaultName{Fault::kDriveDropsOut, "drive_drops_out", "the drive goes to Switch On Disabled"},
    FaultName{Fault::kDriveWrongMode, "drive_wrong_mode", "the drive shows and runs another mode"},
    FaultName{Fault::kDriveFault, "drive_fault", "the drive goes to Fault"},
    FaultName{Fault::kEmergencyTemperature, "emergency_temperature", "EMCY 0x4210, nothing else"},
    FaultName{Fault::kEmergencyCurrent, "emergency_current", "EMCY 0x2310, nothing else"},
    FaultName{Fault::kEmergencyVoltage, "emergency_voltage", "EMCY 0x3210, nothing else"},
    FaultName{Fault::kEmergencyEncoder, "emergency_encoder", "EMCY 0x7305, nothing else"},
    FaultName{Fault::kEmergencyLostMaster, "emergency_lost_master", "EMCY 0x8130, nothing else"},
    FaultName{Fault::kEmergencyExternal, "emergency_external", "EMCY 0x9000, nothing else"},
    FaultName{Fault::kEmergencyMaker, "emergency_maker", "EMCY 0xFF01, nothing else"},
    FaultName{Fault::kEmergencyCleared, "emergency_cleared", "EMCY 0x0000: no error"},
    FaultName{Fault::kEncoderReversed, "encoder_reversed", "the count runs the wrong way"},
    FaultName{Fault::kEncoderJumpTiny, "encoder_jump_tiny", "the count jumps by three at most"},
    FaultName{Fault::kEncoderJump, "encoder_jump", "the count jumps by a tenth of the safe travel"},
    FaultName{Fault::kEncoderJumpLarge, "encoder_jump_large",
              "the count jumps by three times the safe travel"},
    FaultName{Fault::kEncoderFrozen, "encoder_frozen", "the count stands still"},
    FaultName{Fault::kEncoderFlickers, "encoder_flickers", "the count changes by one and back"},
    FaultName{Fault::kTorqueLost, "torque_lost", "no torque, and 0x6077 says so"},
    FaultName{Fault::kTorqueLostSilently, "torque_lost_silently", "no torque, 0x6077 tells the current's"},
    FaultName{Fault::kTorqueHalved, "torque_halved", "half the torque, 0x6077 tells the current's"},
    FaultName{Fault::kLogBlocked, "log_blocked", "nobody empties the telemetry queue"},
    FaultName{Fault::kBusTraffic, "bus_traffic",
              "other nodes send long frames beside ours and hold SYNCs up"},
    FaultName{Fault::kGridPointsSkipped, "grid_points_skipped",
              "the computer sleeps for as many cycles as feedback may be missing"},
    FaultName{Fault::kCyclesLate, "cycles_late", "the frames of every cycle leave late"},
    FaultName{Fault::kPositionBitTop, "position_bit_top",
              "the highest bit but one of one position is flipped"},
    FaultName{Fault::kScaleSilent, "scale_silent", "all readings of the linear scale are lost"},
    FaultName{Fault::kScaleFrozen, "scale_frozen", "the count of the linear scale stands still"},
    FaultName{Fault::kScaleReversed, "scale_reversed", "the count of the linear scale runs the wrong way"},
    FaultName{Fault::kScaleJump, "scale_jump",
              "the count of the linear scale jumps by a tenth of the safe travel"},
    FaultName{Fault::kScaleCountsLess, "scale_counts_less",
              "the count of the linear scale runs by two per cent less than the table"},
    FaultName{Fault::kEncoderCountsLess, "encoder_counts_less",
              "a coupling slips: the count of the motor's encoder runs by two per cent less than the table"},
};
inline constexpr std::size_t kFaultCount = kFaults.size();

/// Those that show what a supervisor is good for, or concern a linear scale, which few machines have, are
/// planned only when they are asked for by name.
constexpr bool IsPlanned(Fault fault) noexcept { return fault < Fault::kGridPointsSkipped; }

constexpr const FaultName& Named(Fault fault) noexcept { return kFaults[static_cast<std::size_t>(fault)]; }
constexpr std::string_view Name(Fault fault) noexcept { return Named(fault).name; }

}  // namespace contour::faults
