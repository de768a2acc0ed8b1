#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "core/fixed_vector.h"
#include "core/reason.h"
#include "core/states.h"

// Sign convention, everywhere: positive torque accelerates towards positive position.
// Motor side: rad, rad/s, Nm. Table side: m, m/s, N, with p = R theta, F = T / R, R = lead / (2 pi) in m/rad.
namespace contour {

inline constexpr std::size_t kMaxAxes = 8;

template <class T>
using PerAxis = FixedVector<T, kMaxAxes>;

/// Lever of a screw, m/rad.
constexpr double ScrewRadius_m_rad(double lead_mm) noexcept {
  return lead_mm * 1e-3 / (2.0 * std::numbers::pi);
}

/// What a drive reported at one SYNC.
struct AxisFeedback {
  double position_rad = 0.0;      ///< motor angle, unwrapped (continues over the INT32 wrap)
  double torque_Nm = 0.0;         ///< torque actual value (0x6077)
  double table_position_m = 0.0;  ///< linear scale, valid when has_scale
  std::uint16_t statusword = 0;   ///< raw, for people who know CiA 402
  DriveState drive_state = DriveState::kUnknown;
  bool fresh = false;  ///< arrived since the last cycle, latched at the last SYNC
  bool valid = false;  ///< has ever arrived since bring-up
  bool has_scale = false;
  std::uint32_t age_cycles = 0;  ///< 0 when fresh; counts up without feedback
  bool scale_fresh = false;      ///< table_position_m belongs to the last SYNC; not in the log
  /// In CST: by which the answer came later than usual, as its SYNC may have; not in the log.
  double late_s = 0.0;
  /// In CST: by which its SYNC is known to have been later than usual; not in the log.
  double sync_late_s = 0.0;
};

/// What the cycle sends to a drive.
struct AxisSetpoint {
  DriveGoal goal = DriveGoal::kDisabled;
  double torque_Nm = 0.0;     ///< target torque (0x6071) in CST, torque offset (0x60B2) in CSP
  double position_rad = 0.0;  ///< target position (0x607A) in CSP
  bool in_motion = false;     ///< the reference moves: torque has to be right on average
};

/// Reference of one axis at one grid point, table units: its motion, and what experiments ask for besides.
struct ReferencePoint {
  double position_m = 0.0;
  double velocity_m_s = 0.0;
  double acceleration_m_s2 = 0.0;
  double extra_torque_Nm = 0.0;  ///< added to the controller's torque over the period that begins here
  double spring_N_m = 0.0;       ///< above 0: an experiment holds the axis by no more than this stiffness
};

/// What an estimator believes of one axis. Table units: position is R theta (the motor seen at the table).
/// "At the sample" is t(k-1), when the newest feedback was latched; "predicted" is t(k), when the torque
/// now being computed starts to act.
struct AxisEstimate {
  double position_m = 0.0;            ///< at the sample
  double velocity_m_s = 0.0;          ///< at the sample
  double predicted_position_m = 0.0;  ///< at t(k)
  double predicted_velocity_m_s = 0.0;
  /// Total at the sample: bristle + viscous + disturbance state; 0 without friction estimation.
  double friction_N = 0.0;
  double friction_std_N = 0.0;  ///< one standard deviation of friction_N
  double bristle_N = 0.0;       ///< sigma0 z at the sample
  double g_plus_N = 0.0;        ///< friction level in the positive direction
  double g_minus_N = 0.0;
  double disturbance_N = 0.0;  ///< leaky disturbance, positive opposes positive motion (as friction does)
  /// One standard deviation of it as a force from outside: what friction is off by shows as one, too.
  double disturbance_std_N = 0.0;
  double sigma0_N_m = 0.0;
  double stiffness_N_m = 0.0;      ///< of the screw, as commissioned and learnt; 0: not estimated
  double stiffness_std_N_m = 0.0;  ///< one standard deviation of it
  double innovation_m = 0.0;       ///< measured minus predicted position
  double innovation_std_m = 0.0;
  /// Of motor and table, where the estimator tells them apart: TwoInertiaLoop's motion at the sample.
  std::array<double, 5> motion{};
  /// The linear scale is fused into it: the table is the scale's, and what screw and encoder are off by is
  /// out of it. Not in the log, as the next.
  bool by_scale = false;
  Reason scale = Reason::kNone;  ///< why the linear scale is not believed: kScaleLost, kScaleDoubted
  Reason limit = Reason::kNone;  ///< kInnovationGated, kParameterBound or kNone
  bool diverged = false;         ///< the numbers are not to be used
};

}  // namespace contour
