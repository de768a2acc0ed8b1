#pragma once

#include <cmath>
#include <cstdint>

#include "control/monitor_config.h"

namespace contour {

/// Of what a loop's proportional term answers, what all of its terms do at most: forces by its stiffness, and
/// the deceleration of an axis that it finds in motion by its bandwidth.
inline constexpr double kLoopOvershoot = 4.0;

/// What the motion monitor has to know of an axis. Table side: forces F = T / R, positions R theta.
struct MonitoredAxis {
  double motor_mass_kg = 0.0;  ///< Jm / R^2
  double table_mass_kg = 0.0;
  double stiffness_N_m = 0.0;  ///< of the screw
  double Fs_N = 0.0;           ///< the larger of both directions
  double Fc_N = 0.0;           ///< the smaller of both directions
  double sigma0_N_m = 0.0;
  double sigma2_Ns_m = 0.0;
  double force_limit_N = 0.0;
  double external_force_N = 0.0;  ///< what may push besides friction
  double rated_force_N = 0.0;
  double count_m = 0.0;          ///< travel per encoder count
  double loop_Hz = 0.0;          ///< bandwidth of the position loop, at least
  double sample_jitter_s = 0.0;  ///< by which a SYNC may come late or early
  double slide_m_s = 0.0;        ///< above this speed the axis slides
  std::uint32_t delay_cycles = 1;
  bool in_cascade = false;  ///< csp: the torque is the drive's own, known by its report only
};

/// By what the reference must have gone further before a reading that stands is none.
struct Standing {
  double moved_m = 0.0;  ///< of the reading itself
  double force_N = 0.0;  ///< that moves the axis as far, by presliding at its stiffest
  /// With a loop of this stiffness.
  [[nodiscard]] double Path_m(double loop_N_m, double settling_N = 0.0) const noexcept {
    return moved_m + (force_N + settling_N) / loop_N_m;
  }
};

/// Periods over which a chatter of the torque is averaged before it must have moved the axis.
inline constexpr double kChatter_periods = 4.0;

/// Share of a change of torque that may still be on its way back while a reading stands.
inline constexpr double kSettlingShare = 0.05;

/// What follows from it; the same numbers decide in the cycle and are printed by `contour check`.
struct MotionThresholds {
  double mass_kg = 0.0;       ///< m, as stated
  double light_kg = 0.0;      ///< m, as light as it may be
  double heavy_kg = 0.0;      ///< m, as heavy as it may be
  double motor_kg = 0.0;      ///< the motor's share alone, as light as it may be
  double friction_N = 0.0;    ///< largest friction at rest
  double viscous_Ns_m = 0.0;  ///< largest viscous friction
  double external_N = 0.0;
  double screw_share_1_kg = 0.0;     ///< of a force, acceleration of the motor beyond that of a rigid axis
  double jitter_s = 0.0;             ///< of the time between two readings
  double reading_m = 0.0;            ///< by which readings may be off, in an acceleration
  double peak_decay = 0.0;           ///< per period, of a force that may still ring in the screw
  double ringing = 0.0;              ///< of a change of force, what its ringing makes of the filtered m a
  double swing_ahead_slow = 1.0;     ///< cosine of what motor and table turn in a period, at their slowest
  double swing_ahead_fast = 1.0;     ///< at their fastest
  double swing_ahead_kept = 0.0;     ///< per period, of what they swung by
  std::uint32_t swing_periods = 0;   ///< that a swing of motor and table takes at most, to and fro
  double swing_filter = 0.0;         ///< of the square of what motor and table swing by
  double swing_left = 0.0;           ///< of a swing that the filter takes out, what it leaves at most
  double swing_gain = 0.0;           ///< of a torque, what its swing may make of m a at the mode
  double frozen_force_N = 0.0;       ///< change of force that must move the encoder
  double flickering_force_N = 0.0;   ///< the same for a reading that stays within flicker_m
  double flicker_m = 0.0;            ///< by which a reading may change and still be the same
  Standing frozen;                   ///< a reading that is exactly the same
  Standing flickering;               ///< one that stays within flicker_m
  std::uint32_t loop_periods = 3;    ///< until the loop has answered a reference that begins to move
  std::uint32_t begin_periods = 2;   ///< until a reference that jumps can show at all
  std::uint32_t force_periods = 20;  ///< our own loops: until a small change of force must have moved it
  double report_periods = 10.0;      ///< low-pass of a drive's report
  std::uint32_t undelivered_periods = 20;  ///< that it must differ for as many more
  std::uint32_t idle_periods = 5;          ///< csp: that an axis that is behind may be without torque
  std::uint32_t scale_samples = 3;         ///< in a row that scale and motor are apart
  double filter = 0.0;                     ///< share of the new value in the filtered forces
  double loop_N_m = 0.0;                   ///< stiffness of the position loop, at least
  double rest_force_N = 0.0;               ///< change of force that counts under a reading that stands
  double pushed_force_N = 0.0;             ///< the same under one that flickers, our own loops
  std::uint32_t pushed_periods = 0;        ///< that it must go on for: until the axis has left the band
  std::uint32_t rest_periods = 0;          ///< csp: that a reading must stand for small changes to count
  double rest_fade = 0.0;
  double swing = 0.0;            ///< csp: of what a report swings by, what its mean may change by
  double tail_N = 0.0;           ///< csp: by which a filtered report may still lag behind
  double tail_decay = 0.0;       ///< of it
  double push_fade = 0.0;        ///< csp: of what the force has changed and swung by
  double push_kept = 1.0;        ///< what is left of it
  double settling_filter = 0.0;  ///< of the torque that a disturbance of before has changed
  double settling_decay = 0.0;
  double frozen_filter = 0.0;
  double unexplained_rel = 0.0;  ///< share of the torque that may go unexplained
  double delivery_N = 0.0;
  double windup_m = 0.0;  ///< largest difference of scale and motor, lead errors apart

  /// csp: readings in a row in which a push of a drive's loop shows: a kick that is over at once has come
  /// back by then.
  static constexpr std::uint32_t kPushReports = 3;
  /// csp: from a push under a reading that stands until it has been told, if it is as large as may ever be:
  /// small changes count by then, or what was under way has arrived, the report is off its own mean, and the
  /// push has shown.
  [[nodiscard]] std::uint32_t PushSeen_periods() const noexcept {
    const auto settled = static_cast<std::uint32_t>(kChatter_periods);
    const std::uint32_t shown = (begin_periods > settled ? begin_periods : settled) + kPushReports;
    return rest_periods > shown ? rest_periods : shown;
  }

  /// Largest displacement in one reading that forces leave unexplained, `n` periods after the one before,
  /// which came `before` periods after its own: e = a T^2 n (n + before) / 2.
  [[nodiscard]] double Forced_m(double velocity_m_s, double peak_force_N, double period_s, double n,
                                double before) const noexcept {
    const double speed_m_s = velocity_m_s < 0.0 ? -velocity_m_s : velocity_m_s;
    const double acceleration_m_s2 =
        (friction_N + viscous_Ns_m * speed_m_s + external_N) / motor_kg + peak_force_N * screw_share_1_kg;
    return acceleration_m_s2 * period_s * period_s * 0.5 * n * (n + before) + reading_m * Weight(n, before);
  }
  /// The same where the SYNCs came as late and early as they may: beyond this the reading is wrong.
  [[nodiscard]] double Jump_m(double velocity_m_s, double peak_force_N, double period_s, double n,
                              double before) const noexcept {
    return Forced_m(velocity_m_s, peak_force_N, period_s, n, before) + Jitter_m(velocity_m_s, n, before);
  }
  /// Of it, what the SYNCs make.
  [[nodiscard]] double Jitter_m(double velocity_m_s, double n, double before) const noexcept {
    return jitter_s * Weight(n, before) * (velocity_m_s < 0.0 ? -velocity_m_s : velocity_m_s);
  }
  /// Change of force that inertia alone takes up while the axis stays within the standing reading's band d
  /// for a time T, at a turning point: of all motions whose acceleration changes evenly, the Chebyshev
  /// polynomial of degree 3 stays in the narrowest band, and its force changes by 96 m d / T^2.
  [[nodiscard]] double Inertial_N(const Standing& standing, double time_s) const noexcept {
    return time_s > 0.0 ? 96.0 * heavy_kg * standing.moved_m / (time_s * time_s) : HUGE_VAL;
  }
  /// How much the middle one of three readings counts, over how much it does when they are evenly apart.
  [[nodiscard]] static double Weight(double n, double before) noexcept {
    return n > before ? 0.5 * (1.0 + n / before) : 1.0;
  }
  /// Force that motion may lack or have beyond the torque, slowly.
  [[nodiscard]] double Unexplained_N(double velocity_m_s, double force_N) const noexcept {
    const double speed_m_s = velocity_m_s < 0.0 ? -velocity_m_s : velocity_m_s;
    const double size_N = force_N < 0.0 ? -force_N : force_N;
    return friction_N + viscous_Ns_m * speed_m_s + external_N + unexplained_rel * size_N;
  }
};

/// What of them goes by the position loop, for one of this bandwidth.
void UseLoop(double loop_Hz, const MonitoredAxis& axis, double period_s,
             MotionThresholds& thresholds) noexcept;

MotionThresholds ThresholdsOf(const MonitoredAxis& axis, const MonitorConfig& config,
                              double period_s) noexcept;

}  // namespace contour
