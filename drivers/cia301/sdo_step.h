#pragma once

#include <cstdint>

#include "drivers/cia301/bring_up_status.h"

namespace contour {

/// What a step of a configuration script does with its object.
enum class SdoAction : std::uint8_t {
  kWrite,            ///< write `value`
  kEqual,            ///< read; (found & mask) must equal value; `error` says what a difference means
  kNear,             ///< read; must lie within `tolerance` of value, and not be 0
  kBits,             ///< read; all bits of value must be set
  kAtLeast,          ///< read; must be value or more
  kKeep,             ///< read; kept for the next kRatio
  kRatio,            ///< read; kept / found must equal value
  kPoll,             ///< read again and again until it equals value, or `deadline_cycles`
  kRequireWatchdog,  ///< no transfer: at least one step marked `watchdog` must have succeeded
  kCompare,          ///< read; a difference is no error but marked, for the steps with `only_if`
};

/// Which refusals a step puts up with.
enum class Tolerate : std::uint8_t {
  kNothing,
  kAbsent,    ///< no such object or sub-index
  kReadOnly,  ///< that, or it cannot be written
  kAnyAbort,
};

/// One step of the script that configures a node over SDO.
struct SdoStep {
  BringUpPhase phase = BringUpPhase::kOff;
  SdoAction action = SdoAction::kWrite;
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  std::uint8_t size = 4;  ///< bytes, of a write
  std::uint32_t value = 0;
  std::uint32_t mask = 0xFFFFFFFF;
  std::uint32_t tolerance = 0;
  BringUpError error = BringUpError::kReadBack;  ///< of a comparison that fails
  Tolerate tolerate = Tolerate::kNothing;
  bool watchdog = false;     ///< holding this value makes the node notice a silent master
  bool after_write = false;  ///< skipped when the write before it was refused and that was put up with
  std::uint64_t deadline_cycles = 0;  ///< of kPoll
  // What is right already is not written. Marks are bits that mean something within one group of steps.
  bool first = false;        ///< of a group: forgets all marks
  std::uint8_t mark = 0;     ///< set by kCompare where the object differs
  std::uint8_t only_if = 0;  ///< skipped unless one of these marks is set; 0: never skipped
  std::uint8_t skip_if = 0;  ///< skipped when one of these marks is set
  bool or_zero = false;      ///< 0 is right as well where it cannot be written
};

}  // namespace contour
