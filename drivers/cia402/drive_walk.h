#pragma once

#include <cstdint>

#include "core/states.h"

namespace contour {

/// Walks one drive through the CiA 402 state machine towards a goal, one transition at a time, each with a
/// deadline.
class DriveWalk {
 public:
  DriveWalk() = default;
  DriveWalk(std::uint64_t transition_cycles, std::uint64_t quick_stop_cycles) noexcept
      : transition_cycles_(transition_cycles), quick_stop_cycles_(quick_stop_cycles) {}

  /// Controlword for this cycle. `elapsed_cycles` since the last call.
  std::uint16_t Step(DriveState state, DriveGoal goal, std::uint64_t elapsed_cycles) noexcept;

  /// Forgets goal and history, as after a bring-up.
  void Reset() noexcept;

  [[nodiscard]] bool at_goal() const noexcept { return at_goal_; }
  /// The drive stayed in `stuck_in()` for longer than a transition may take; until state or goal change.
  [[nodiscard]] bool late() const noexcept { return late_; }
  [[nodiscard]] DriveState stuck_in() const noexcept { return late_ ? state_ : DriveState::kUnknown; }
  /// Cycles in this state with this goal.
  [[nodiscard]] std::uint64_t in_state_cycles() const noexcept { return in_state_; }
  /// The drive was enabled, was to stay so, and is not any more; until the goal changes.
  [[nodiscard]] bool left_enabled() const noexcept { return left_enabled_; }

 private:
  std::uint16_t FaultReset() noexcept;

  std::uint64_t transition_cycles_ = 500;
  std::uint64_t quick_stop_cycles_ = 1000;
  std::uint64_t in_state_ = 0;     ///< cycles in this state with this goal, away from it
  std::uint64_t reset_phase_ = 0;  ///< cycles within the fault reset's square wave
  DriveState state_ = DriveState::kUnknown;
  DriveGoal goal_ = DriveGoal::kDisabled;
  bool at_goal_ = false;
  bool late_ = false;
  bool was_enabled_ = false;
  bool left_enabled_ = false;
};

}  // namespace contour
