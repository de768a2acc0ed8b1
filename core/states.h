#pragma once

#include <cstdint>
#include <string_view>

namespace contour {

/// State of the whole machine, as `contour status` shows it. Values are part of the log format.
enum class MachineState : std::uint8_t {
  kOff = 0,       ///< bus or drives not up
  kStarting = 1,  ///< drives are being found and configured
  kIdle = 2,      ///< drives configured, Switched On or below; no torque
  kEnabling = 3,  ///< walking the drives to Operation Enabled
  kReady = 4,     ///< enabled, holding position
  kRunning = 5,   ///< following a program
  kStopping = 6,  ///< a stop is under way
  kFaulted = 7,   ///< stopped by a fault; waits for reset
};

constexpr std::string_view Name(MachineState s) noexcept {
  switch (s) {
    case MachineState::kOff:
      return "Off";
    case MachineState::kStarting:
      return "Starting";
    case MachineState::kIdle:
      return "Idle";
    case MachineState::kEnabling:
      return "Enabling";
    case MachineState::kReady:
      return "Ready";
    case MachineState::kRunning:
      return "Running";
    case MachineState::kStopping:
      return "Stopping";
    case MachineState::kFaulted:
      return "Faulted";
  }
  return "unknown";
}

/// CiA 402 power drive system state, decoded from the statusword (0x6041). Values are part of the log format.
enum class DriveState : std::uint8_t {
  kUnknown = 0,
  kNotReadyToSwitchOn = 1,
  kSwitchOnDisabled = 2,
  kReadyToSwitchOn = 3,
  kSwitchedOn = 4,
  kOperationEnabled = 5,
  kQuickStopActive = 6,
  kFaultReactionActive = 7,
  kFault = 8,
};

constexpr std::string_view Name(DriveState s) noexcept {
  switch (s) {
    case DriveState::kUnknown:
      return "Unknown";
    case DriveState::kNotReadyToSwitchOn:
      return "Not Ready To Switch On";
    case DriveState::kSwitchOnDisabled:
      return "Switch On Disabled";
    case DriveState::kReadyToSwitchOn:
      return "Ready To Switch On";
    case DriveState::kSwitchedOn:
      return "Switched On";
    case DriveState::kOperationEnabled:
      return "Operation Enabled";
    case DriveState::kQuickStopActive:
      return "Quick Stop Active";
    case DriveState::kFaultReactionActive:
      return "Fault Reaction Active";
    case DriveState::kFault:
      return "Fault";
  }
  return "unknown";
}

/// What the cycle wants of a drive; the driver walks there one transition at a time.
enum class DriveGoal : std::uint8_t {
  kDisabled = 0,    ///< Switch On Disabled: disable voltage
  kSwitchedOn = 1,  ///< Switched On, no torque
  kEnabled = 2,     ///< Operation Enabled
  kQuickStop = 3,   ///< the drive stops by its own quick-stop ramp, then Switch On Disabled
  kFaultReset = 4,  ///< rising edge of controlword bit 7, then Switch On Disabled
};

}  // namespace contour
