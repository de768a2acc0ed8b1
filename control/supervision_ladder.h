#pragma once

#include <cstdint>

#include "core/reason.h"

namespace contour {

/// How far the machine has gone against what it found wrong with itself.
enum class SupervisionStep : std::uint8_t { kNone, kNoticed, kSoftened, kFallenBack, kStopped };

/// One step for an alarm, whoever raises it, with some time between two steps, in which what a step changes
/// can act; one step back after a quiet time. A step that the machine does not have (nothing to fall back to)
/// is gone through all the same, so that the time to a stop is the same.
///
/// Where a violent swing returns once softness was taken back, softness is all that keeps the machine quiet.
/// To give it and take it again and again would be a burst for every quiet time, so such a return is the last
/// step. What the machine bears for a quiet time as it is, with nothing taken back any more, is forgotten.
class SupervisionLadder {
 public:
  SupervisionLadder() noexcept = default;
  SupervisionLadder(std::uint32_t step_cycles, std::uint32_t quiet_cycles) noexcept
      : step_cycles_(step_cycles), since_(step_cycles), quiet_cycles_(quiet_cycles) {}

  void Reset() noexcept {
    step_ = SupervisionStep::kNone;
    reason_ = Reason::kNone;
    where_ = 0xFF;
    quiet_ = 0;
    since_ = step_cycles_;
    violent_ = taken_back_ = false;
  }

  /// Once per cycle; kNone: nothing was found. `violent`: no machine is to be left to it.
  void Step(Reason alarm, std::uint8_t where, bool violent = false) noexcept {
    since_ = since_ < step_cycles_ ? since_ + 1 : since_;
    if (alarm != Reason::kNone) {
      quiet_ = 0;
      const bool returned = violent && taken_back_;
      violent_ = violent_ || violent;
      if (since_ < step_cycles_ && !returned) return;
      since_ = 0;
      reason_ = alarm;
      where_ = where;
      if (returned)
        step_ = SupervisionStep::kStopped;
      else if (step_ != SupervisionStep::kStopped)
        step_ = Next(step_, 1);
    } else if (step_ != SupervisionStep::kNone && step_ != SupervisionStep::kStopped &&
               ++quiet_ >= quiet_cycles_) {
      quiet_ = 0;
      if (step_ == SupervisionStep::kSoftened) taken_back_ = violent_;
      step_ = Next(step_, -1);
      if (step_ == SupervisionStep::kNone) Reset();
    }
  }

  [[nodiscard]] SupervisionStep step() const noexcept { return step_; }
  /// Of the last alarm, as the fault it becomes; kNone when all is quiet.
  [[nodiscard]] Reason reason() const noexcept { return reason_; }
  [[nodiscard]] std::uint8_t where() const noexcept { return where_; }

 private:
  static SupervisionStep Next(SupervisionStep s, int by) noexcept {
    return static_cast<SupervisionStep>(static_cast<int>(s) + by);
  }
  std::uint32_t step_cycles_ = 0;
  std::uint32_t since_ = 0;
  std::uint32_t quiet_cycles_ = 5000;
  std::uint32_t quiet_ = 0;
  SupervisionStep step_ = SupervisionStep::kNone;
  bool violent_ = false;     ///< an alarm was, since all was quiet
  bool taken_back_ = false;  ///< softness, after such an alarm
  Reason reason_ = Reason::kNone;
  std::uint8_t where_ = 0xFF;
};

/// Says so once when something has been true so often in a row; 0: never.
class InARow {
 public:
  InARow() noexcept = default;
  explicit InARow(std::int32_t bound) noexcept : bound_(bound) {}
  void Reset() noexcept { count_ = 0; }
  bool Step(bool now) noexcept {
    count_ = now ? count_ + 1 : 0;
    if (bound_ == 0 || count_ < bound_) return false;
    count_ = 0;
    return true;
  }

 private:
  std::int32_t bound_ = 0;
  std::int32_t count_ = 0;
};

}  // namespace contour
