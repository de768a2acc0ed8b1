#pragma once

#include <array>
#include <cstddef>

#include "core/loop_tuning.h"
#include "core/two_inertia_axis.h"

// A loop that knows two inertias: a stationary Kalman filter, a linear-quadratic regulator and one torque
// filter, around the exact motion of motor and table over one period. It is linear, so it works in any
// coordinates that fulfil the same equations: positions, or deviations from a reference.
//
// At sample j, with y the encoder's position R theta (and the table's, with a scale):
//
//   x = x + gain (y - [p1 + b, p2])          (b and the second row with a scale only)
//   command = filter(d - regulator . (x, queue) + d steady)
//   x = motion_from_motion x + motion_from_input[0] input[0] + motion_from_input[1] input[1]
//       + motion_from_disturbance d
//
// `queue` are the commands under way, the one that acts first in front, and `input` is the queue with the new
// command behind it, as the drive really gets it: after filter, limits and rounding.
namespace contour {

inline constexpr std::size_t kLoopMotion = 5;  ///< p1, v1 (motor), p2, v2 (table), u (force of the motor)
inline constexpr std::size_t kLoopQueue = 6;   ///< commands under way, at most
inline constexpr std::size_t kLoopTaps = 40;
/// States of the observer: the motion, b (encoder minus scale beyond the wind-up), d (force on the table).
inline constexpr std::size_t kObserverStates = kLoopMotion + 2;
inline constexpr std::size_t kObserverBias = kLoopMotion;
inline constexpr std::size_t kObserverDisturbance = kLoopMotion + 1;

using LoopMotion = std::array<double, kLoopMotion>;  ///< m, m/s, m, m/s, N

/// y(j) = b0 x(j) + b1 x(j-1) + b2 x(j-2) - a1 y(j-1) - a2 y(j-2)
struct Biquad {
  double b0 = 1.0, b1 = 0.0, b2 = 0.0;
  double a1 = 0.0, a2 = 0.0;
};

/// All of one axis's loop, SI units at the table.
struct TwoInertiaLoop {
  // The axis over one period.
  std::array<LoopMotion, kLoopMotion> motion_from_motion{};
  std::array<LoopMotion, 2> motion_from_input{};  ///< of input 0 and 1; the second without a dead time is 0
  LoopMotion motion_from_disturbance{};           ///< per newton that opposes positive motion
  std::size_t queued = 0;                         ///< commands under way at a sample
  /// Of a period: the dead time beyond whole ones, for which the command before still acts.
  double late_share = 0.0;
  bool scale = false;

  /// Rows p1, v1, p2, v2, u, b, d; columns encoder and scale. Without a scale, b and the second column are 0.
  std::array<std::array<double, 2>, kObserverStates> gain{};

  LoopMotion regulator_motion{};                     ///< N per state
  std::array<double, kLoopQueue> regulator_queue{};  ///< N per newton under way
  /// The motion at rest under a force of 1 N on the table: the motor leads by 1 / K. All of the queue is 1.
  LoopMotion steady_motion{};
  /// N per newton of d: what the regulator adds to a command at rest, 1 + regulator . steady.
  double disturbance_to_command = 0.0;

  Biquad filter{};
  /// From the force on the table over period j to d at sample j + i, in a loop of any regulator.
  std::array<double, kLoopTaps> disturbance_response{};

  /// Periods until a command begins to act.
  [[nodiscard]] std::size_t whole_delay() const noexcept { return late_share > 0.0 ? queued - 1 : queued; }
};

/// Frequency of the screw's mode: motor against table, both free.
[[nodiscard]] double ModeFrequency_Hz(const TwoInertiaAxis& axis) noexcept;

/// The motion of the axis over one period, the part of the loop that no tuning changes.
/// Throws std::invalid_argument with the name of a value that cannot be.
TwoInertiaLoop LoopMotionOf(const TwoInertiaAxis& axis, double period_s);

/// What the observer of a loop finds of a force, d at sample j + i per newton over period j. `motion_per_N`:
/// what a newton that opposes positive motion does to the motion over one period.
[[nodiscard]] std::array<double, kLoopTaps> ResponseOfObserver(const TwoInertiaLoop& loop,
                                                               const LoopMotion& motion_per_N) noexcept;

/// The whole loop. Throws std::invalid_argument with the name of a value that cannot be, or of the gain that
/// no such loop has. That it is stable on an axis that is not quite as stated is for design/loop_margins.h.
TwoInertiaLoop DesignLoop(const TwoInertiaAxis& axis, const LoopTuning& tuning, double period_s, bool scale);

}  // namespace contour
