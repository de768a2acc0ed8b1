#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace contour {

/// Which part of a late cycle was late, or what held it up. Values are part of the log format: append, never
/// renumber.
enum class LateCause : std::uint8_t {
  kNone = 0,       ///< the cycle was in time
  kWakeUp = 1,     ///< the timer, an interrupt or the machine below: nothing else wanted the CPU
  kReceive = 2,    ///< taking the frames from the buses
  kEstimate = 3,   ///< estimators
  kControl = 4,    ///< controller (MPC), guard and encoding
  kSend = 5,       ///< handing the frames to the buses
  kAfterSend = 6,  ///< telemetry of the cycle before
  kPageFault = 7,  ///< memory that was not there
  kPreempted = 8,  ///< another thread had the CPU
  kThrottled = 9,  ///< the kernel's real-time throttling
  kStopped = 10,   ///< the thread was stopped (SIGSTOP, a debugger) or waited inside the kernel
};
inline constexpr std::size_t kLateCauses = 11;

constexpr std::string_view Name(LateCause c) noexcept {
  constexpr std::array<std::string_view, kLateCauses> kNames{
      "none",       "wake_up",    "receive",   "estimate",  "control", "send",
      "after_send", "page_fault", "preempted", "throttled", "stopped"};
  const auto i = static_cast<std::size_t>(c);
  return i < kNames.size() ? kNames[i] : "unknown";
}

}  // namespace contour
