#include "drivers/cia402/drive_walk.h"

#include "drivers/cia402/drive_state.h"

namespace contour {
namespace {

// The fault reset is a square wave, so that a drive that was not yet ready for the first edge sees another:
// low for two cycles, since a drive applies one controlword per SYNC, then high.
constexpr std::uint64_t kResetLowCycles = 2;
constexpr std::uint64_t kResetPeriodCycles = 20;

}  // namespace

void DriveWalk::Reset() noexcept {
  in_state_ = 0;
  reset_phase_ = 0;
  state_ = DriveState::kUnknown;
  goal_ = DriveGoal::kDisabled;
  at_goal_ = late_ = was_enabled_ = left_enabled_ = false;
}

std::uint16_t DriveWalk::Step(DriveState state, DriveGoal goal, std::uint64_t elapsed_cycles) noexcept {
  if (goal != goal_) was_enabled_ = left_enabled_ = false;
  if (goal != goal_ || state != state_) {
    goal_ = goal;
    state_ = state;
    in_state_ = 0;
    reset_phase_ = 0;
    late_ = false;
  } else {
    in_state_ += elapsed_cycles;
  }
  at_goal_ = IsAt(state, goal);
  const bool stopping = state == DriveState::kQuickStopActive || state == DriveState::kFaultReactionActive;
  late_ = !at_goal_ && in_state_ >= (stopping ? quick_stop_cycles_ : transition_cycles_);

  if (goal == DriveGoal::kEnabled) {
    left_enabled_ = left_enabled_ || (was_enabled_ && !at_goal_);
    was_enabled_ = was_enabled_ || at_goal_;
    // A drive that left Operation Enabled by itself is not enabled again behind the operator's back.
    if (left_enabled_) return controlword::kQuickStop;
  }
  if (goal == DriveGoal::kFaultReset && state == DriveState::kFault) return FaultReset();
  // A quick stop that does not end (options 5 to 8 stay in Quick Stop Active), or is not even begun, ends by
  // disabling the voltage.
  const bool stops = state == DriveState::kQuickStopActive || state == DriveState::kOperationEnabled;
  if (goal == DriveGoal::kQuickStop && stops && late_) {
    return controlword::kDisableVoltage;
  }
  return Controlword(state, goal);
}

std::uint16_t DriveWalk::FaultReset() noexcept {
  const std::uint64_t phase = reset_phase_++ % kResetPeriodCycles;
  return phase < kResetLowCycles ? controlword::kDisableVoltage : controlword::kFaultReset;
}

}  // namespace contour
