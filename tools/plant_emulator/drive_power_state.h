#pragma once

#include <cstdint>

#include "core/states.h"

namespace contour::plant {

/// The CiA 402 power drive state machine, on the drive's side. One transition per step.
class DrivePowerState {
 public:
  /// What the caller has to carry out after a step.
  enum class Action : std::uint8_t {
    kNone,
    kStarted,           ///< entered Operation Enabled: control may act
    kTorqueOff,         ///< torque must be zero at once
    kQuickStop,         ///< entered Quick Stop Active: brake by 0x605A
    kDisableOperation,  ///< asked to leave for Switched On: brake by 0x605C, then LeftOperation()
    kShutdown,          ///< asked to leave for Ready To Switch On: brake by 0x605B, then LeftOperation()
    kFaultReset,        ///< left Fault
  };

  [[nodiscard]] DriveState state() const noexcept { return state_; }

  /// `controlword` as it stands now.
  Action Step(std::uint16_t controlword) noexcept {
    const bool reset = (controlword & 0x80U) != 0;
    const bool reset_edge = reset && !reset_seen_;
    reset_seen_ = reset;
    const bool voltage = (controlword & 0x02U) != 0;
    const bool run = (controlword & 0x04U) != 0;  // 0: quick stop, when voltage is on
    const bool switch_on = (controlword & 0x01U) != 0;
    const bool enable = (controlword & 0x08U) != 0;
    switch (state_) {
      case DriveState::kNotReadyToSwitchOn:
        state_ = DriveState::kSwitchOnDisabled;
        return Action::kNone;
      case DriveState::kSwitchOnDisabled:
        if (voltage && run && !switch_on) state_ = DriveState::kReadyToSwitchOn;
        return Action::kNone;
      case DriveState::kReadyToSwitchOn:
        if (!voltage || !run) return Leave(DriveState::kSwitchOnDisabled);
        if (switch_on) state_ = DriveState::kSwitchedOn;
        return Action::kNone;
      case DriveState::kSwitchedOn:
        if (!voltage || !run) return Leave(DriveState::kSwitchOnDisabled);
        if (!switch_on) return Leave(DriveState::kReadyToSwitchOn);
        if (!enable) return Action::kNone;
        state_ = DriveState::kOperationEnabled;
        return Action::kStarted;
      case DriveState::kOperationEnabled:
        if (!voltage) return Leave(DriveState::kSwitchOnDisabled);
        if (!run) {
          state_ = DriveState::kQuickStopActive;
          return Action::kQuickStop;
        }
        if (!switch_on) return Action::kShutdown;
        return enable ? Action::kNone : Action::kDisableOperation;
      case DriveState::kQuickStopActive:
        return voltage ? Action::kNone : Leave(DriveState::kSwitchOnDisabled);
      case DriveState::kFault:
        if (!reset_edge) return Action::kNone;
        state_ = DriveState::kSwitchOnDisabled;
        return Action::kFaultReset;
      case DriveState::kFaultReactionActive:
      case DriveState::kUnknown:
        return Action::kNone;
    }
    return Action::kNone;
  }

  /// A fault was seen: true when the drive was in control of the motor and a fault reaction begins.
  bool Fault() noexcept {
    if (state_ == DriveState::kFault || state_ == DriveState::kFaultReactionActive) return false;
    const bool moving = InControl();
    state_ = moving ? DriveState::kFaultReactionActive : DriveState::kFault;
    return moving;
  }
  void FaultReactionDone() noexcept { state_ = DriveState::kFault; }
  void QuickStop() noexcept { state_ = DriveState::kQuickStopActive; }
  void Disable() noexcept { state_ = DriveState::kSwitchOnDisabled; }
  void LeftOperation(DriveState to) noexcept { state_ = to; }
  /// The self-test takes no time here: Not Ready To Switch On is over before the first message.
  void PowerOn() noexcept {
    state_ = DriveState::kSwitchOnDisabled;
    reset_seen_ = false;
  }

  [[nodiscard]] bool InControl() const noexcept {
    return state_ == DriveState::kOperationEnabled || state_ == DriveState::kQuickStopActive ||
           state_ == DriveState::kFaultReactionActive;
  }

  /// State bits of the statusword (0x6041): & 0x6F and, for faults, & 0x4F.
  [[nodiscard]] std::uint16_t StatusBits() const noexcept {
    switch (state_) {
      case DriveState::kSwitchOnDisabled:
        return 0x0040;
      case DriveState::kReadyToSwitchOn:
        return 0x0021;
      case DriveState::kSwitchedOn:
        return 0x0023;
      case DriveState::kOperationEnabled:
        return 0x0027;
      case DriveState::kQuickStopActive:
        return 0x0007;
      case DriveState::kFaultReactionActive:
        return 0x000F;
      case DriveState::kFault:
        return 0x0008;
      case DriveState::kNotReadyToSwitchOn:
      case DriveState::kUnknown:
        return 0x0000;
    }
    return 0x0000;
  }

 private:
  Action Leave(DriveState to) noexcept {
    const bool was_on = InControl();
    state_ = to;
    return was_on ? Action::kTorqueOff : Action::kNone;
  }

  DriveState state_ = DriveState::kSwitchOnDisabled;
  bool reset_seen_ = false;
};

}  // namespace contour::plant
