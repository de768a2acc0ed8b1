#pragma once

#include <cstdint>

#include "core/states.h"

// Pure tables of the CiA 402 power drive system: statusword to state, (state, goal) to controlword.
namespace contour {

namespace controlword {
inline constexpr std::uint16_t kDisableVoltage = 0x0000;
inline constexpr std::uint16_t kQuickStop = 0x0002;
inline constexpr std::uint16_t kShutdown = 0x0006;
inline constexpr std::uint16_t kSwitchOn = 0x0007;  ///< also "disable operation", seen from Operation Enabled
inline constexpr std::uint16_t kEnableOperation = 0x000F;
inline constexpr std::uint16_t kFaultReset = 0x0080;  ///< acts on the rising edge
}  // namespace controlword

/// State in a statusword (0x6041).
constexpr DriveState DecodeStatusword(std::uint16_t statusword) noexcept {
  switch (statusword & 0x4F) {
    case 0x00:
      return DriveState::kNotReadyToSwitchOn;
    case 0x40:
      return DriveState::kSwitchOnDisabled;
    case 0x0F:
      return DriveState::kFaultReactionActive;
    case 0x08:
      return DriveState::kFault;
    default:
      break;
  }
  switch (statusword & 0x6F) {
    case 0x21:
      return DriveState::kReadyToSwitchOn;
    case 0x23:
      return DriveState::kSwitchedOn;
    case 0x27:
      return DriveState::kOperationEnabled;
    case 0x07:
      return DriveState::kQuickStopActive;
    default:
      return DriveState::kUnknown;
  }
}

namespace statusword {
inline constexpr std::uint16_t kWarning = 0x0080;        ///< bit 7: something that is no fault yet
inline constexpr std::uint16_t kRemote = 0x0200;         ///< bit 9: the controlword is obeyed
inline constexpr std::uint16_t kFollowsTarget = 0x1000;  ///< bit 12, in the cyclic synchronous modes
}  // namespace statusword

/// Controlword (0x6040) that takes a drive one transition further from `state` towards `goal`, or keeps it
/// there. The fault reset needs an edge, which the caller makes; here it is the level that keeps bit 7 low.
constexpr std::uint16_t Controlword(DriveState state, DriveGoal goal) noexcept {
  using enum DriveState;
  const bool walks_up = goal == DriveGoal::kSwitchedOn || goal == DriveGoal::kEnabled;
  if (goal == DriveGoal::kQuickStop) return controlword::kQuickStop;
  if (!walks_up) return controlword::kDisableVoltage;
  switch (state) {
    case kSwitchOnDisabled:
      return controlword::kShutdown;
    case kReadyToSwitchOn:
      return controlword::kSwitchOn;
    case kSwitchedOn:
    case kOperationEnabled:
      return goal == DriveGoal::kEnabled ? controlword::kEnableOperation : controlword::kSwitchOn;
    default:
      return controlword::kDisableVoltage;  // leaves Quick Stop Active; nothing to do in the other states
  }
}

/// Whether `state` is where `goal` wants to be.
constexpr bool IsAt(DriveState state, DriveGoal goal) noexcept {
  switch (goal) {
    case DriveGoal::kDisabled:
    case DriveGoal::kQuickStop:
      return state == DriveState::kSwitchOnDisabled;
    case DriveGoal::kSwitchedOn:
      return state == DriveState::kSwitchedOn;
    case DriveGoal::kEnabled:
      return state == DriveState::kOperationEnabled;
    case DriveGoal::kFaultReset:
      return state != DriveState::kFault && state != DriveState::kFaultReactionActive &&
             state != DriveState::kUnknown;
  }
  return false;
}

constexpr bool IsFaultState(DriveState state) noexcept {
  return state == DriveState::kFault || state == DriveState::kFaultReactionActive;
}

}  // namespace contour
