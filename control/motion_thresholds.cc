#include "control/motion_thresholds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contour {
namespace {

// The screw's oscillation has to pass the filters of force by so little that it does not count.
constexpr double kBelowMode = 3.0;
// Oscillations of a screw whose damping is not known are taken to last for so many periods of its mode.
constexpr double kRinging_periods = 5.0;
// A screw may be so many times softer than stated: what catalogues leave open.
constexpr double kSofterScrew = 2.0;
// Of the torque limit, what is left over friction and outside forces must do to be told from nothing.
constexpr double kSureOfLimit = 0.9;
// Largest share of the torque that may go unexplained: a table that was made much heavier than stated.
constexpr double kMostUnexplained = 0.6;
// Of a scale that does not see the motor: wind-up at the torque limit, with this much room for damping.
constexpr double kWindupRoom = 1.5;
// Of friction: what the torque may still change by while a disturbance of before settles.
constexpr double kSettling = 0.005;
// A disturbance shows in the torque faster than this, and integral action has settled it after that.
constexpr double kSettlingBegin_s = 0.05;
constexpr double kSettlingEnd_s = 0.2;
// Share of the report's error that is noise.
constexpr double kReportNoise = 0.2;
// Our own loops: changes of force slower than this at rest may be from outside.
constexpr double kRest_s = 0.5;
// A filtered report has come down to the torque by most after so many of its time constants.
constexpr double kReportSettles = 2.0;
// csp: of what a report swings by around its mean over kChatter_periods, what that mean may change by: twice
// that for noise and hum; for a report that is filtered over kReport_s what it still lags behind by.
constexpr double kSwingNoise = 2.0;
constexpr double kSwingTail = 1.2;
// csp: for so long what a report swings by is remembered, and what it has changed by: a sensor that warms
// drifts within minutes.
constexpr double kPushForgotten_s = 2.0;
// Time constants of the loop until it has answered.
constexpr double kAnswer = 2.0;
// How long a reading stands under our own loops before a small change of force must have moved it.
constexpr double kSameForForce_s = 20e-3;
// Drives filter their report: it is low-passed over as long, and must differ for the second.
constexpr double kReport_s = 10e-3;
constexpr double kUndelivered_s = 20e-3;
// csp: an axis that is behind is without torque for no longer.
constexpr double kIdle_s = 5e-3;
// The scale comes in a message of its own, of which one or two may be lost or late.
constexpr double kScaleApart_s = 3e-3;
constexpr std::uint32_t kScaleSamples = 3;
// Cycles by which a drive may answer later than stated.
constexpr std::uint32_t kLaterThanStated = 1;
// Noise of the filtered force by the encoder's steps, as a share of the outside force.
constexpr double kNoiseShare = 0.2;

// At least one.
std::uint32_t Periods(double time_s, double period_s) noexcept {
  return static_cast<std::uint32_t>(std::max(std::lround(time_s / period_s), 1L));
}

// csp: what a drive's report may do at rest before its own loop counts as pushing.
void UseReport(const MonitoredAxis& a, const MonitorConfig& c, double period_s,
               MotionThresholds& t) noexcept {
  t.rest_force_N = t.frozen.force_N + kReportNoise * c.reported_torque_error_rel * a.rated_force_N;
  t.pushed_force_N = t.rest_force_N + t.flickering.force_N - t.frozen.force_N;
  t.rest_periods = Periods(kReportSettles * kReport_s, period_s);
  t.push_kept = std::exp(-period_s / kPushForgotten_s);
  t.push_fade = 1.0 - t.push_kept;
  // Its mean follows later still.
  t.tail_decay = std::exp(-period_s / (kReport_s + 0.5 * kChatter_periods * period_s));
  t.swing = std::max(kSwingNoise, kSwingTail * kReport_s / (kChatter_periods * period_s));
  // Half of what a report's noise may be.
  t.tail_N = 0.5 * (t.rest_force_N - t.frozen.force_N) / t.swing;
  t.rest_fade = 1.0 - std::exp(-period_s / kRest_s);
  t.begin_periods = a.delay_cycles + kLaterThanStated;
  // In long cycles a report has settled before what is under way has arrived.
  t.rest_periods = std::max(t.rest_periods, t.begin_periods + 1);
  // Inertia holds what is pushed that long within the band.
  t.pushed_periods = t.begin_periods +
                     Periods(std::sqrt(2.0 * t.heavy_kg * t.flickering.moved_m / t.pushed_force_N), period_s);
}

// A table of any mass swings on its motor no slower than the motor alone would on the screw; lighter than
// stated it swings faster.
void UseSwing(const MonitoredAxis& a, const MonitorConfig& c, double period_s, MotionThresholds& t) noexcept {
  const double table_kg = std::max((1.0 - c.mass_error_rel) * a.table_mass_kg, 1e-9);
  const double motor_kg = std::max(t.motor_kg, 1e-9);
  const double slow_rad_s = std::sqrt(
      a.stiffness_N_m / (kSofterScrew * (1.0 + c.mass_error_rel) * std::max(a.motor_mass_kg, 1e-9)));
  const double fast_rad_s =
      std::sqrt(kSofterScrew * a.stiffness_N_m * (motor_kg + table_kg) / (motor_kg * table_kg));
  t.swing_ahead_slow = std::cos(std::min(slow_rad_s * period_s, std::numbers::pi));
  t.swing_ahead_fast = std::cos(std::min(fast_rad_s * period_s, std::numbers::pi));
  t.swing_ahead_kept = std::exp(-period_s * slow_rad_s / (2.0 * std::numbers::pi));
}

}  // namespace

// The controller's stiffness goes by the mass it was told; a drive's own by the mass it was tuned for.
void UseLoop(double loop_Hz, const MonitoredAxis& a, double period_s, MotionThresholds& t) noexcept {
  const double loop_rad_s = 2.0 * std::numbers::pi * loop_Hz;
  t.loop_N_m = (a.in_cascade ? t.light_kg : t.mass_kg) * loop_rad_s * loop_rad_s;
  t.loop_periods = static_cast<std::uint32_t>(std::max(3.0, std::ceil(kAnswer / (loop_rad_s * period_s))));
}

MotionThresholds ThresholdsOf(const MonitoredAxis& a, const MonitorConfig& c, double period_s) noexcept {
  MotionThresholds t;
  t.mass_kg = a.motor_mass_kg + a.table_mass_kg;
  t.light_kg = (1.0 - c.mass_error_rel) * t.mass_kg;
  t.heavy_kg = (1.0 + c.mass_error_rel) * t.mass_kg;
  t.motor_kg = (1.0 - c.mass_error_rel) * a.motor_mass_kg;
  t.friction_N = c.friction_factor * a.Fs_N;
  t.viscous_Ns_m = c.friction_factor * a.sigma2_Ns_m;
  t.external_N = a.external_force_N;
  t.screw_share_1_kg = 1.0 / t.motor_kg - 1.0 / t.heavy_kg;
  // One misread reading comes twice into a second difference; rounding of three readings up to two counts.
  t.reading_m = (2.0 * c.misread_counts + 2.0) * a.count_m;

  // Of three readings the middle one counts twice.
  t.jitter_s = 4.0 * a.sample_jitter_s;

  const double mode_rad_s =
      std::sqrt(a.stiffness_N_m * t.mass_kg / std::max(1e-9, a.motor_mass_kg * a.table_mass_kg));
  const double ringing_s = std::max(5.0 * period_s, kRinging_periods * 2.0 * std::numbers::pi / mode_rad_s);
  t.peak_decay = std::exp(-period_s / ringing_s);

  // In presliding the axis gives way by force over stiffness, at break-away altogether.
  const auto standing = [&](double by_m) {
    const double settling_N = kSettling * t.friction_N;
    return Standing{by_m, settling_N + std::min(c.presliding_factor * a.sigma0_N_m * by_m,
                                                2.0 * t.friction_N + t.external_N)};
  };
  const double step_m = (c.hysteresis_counts + 1) * a.count_m;
  t.frozen = standing(step_m);
  // To and fro by a step, and as far again to leave it.
  t.flicker_m = 1.25 * step_m;
  t.flickering = standing(2.0 * t.flicker_m);
  // Outside forces and friction that settles on the table are answered by torque while the motor stands.
  t.frozen_force_N = t.friction_N + t.external_N + t.frozen.force_N;
  t.flickering_force_N = t.friction_N + t.external_N + t.flickering.force_N;
  UseLoop(a.loop_Hz, a, period_s, t);
  UseReport(a, c, period_s, t);
  t.force_periods = Periods(kSameForForce_s, period_s);
  t.report_periods = kReport_s / period_s;
  t.undelivered_periods = Periods(kUndelivered_s, period_s);
  t.idle_periods = Periods(kIdle_s, period_s);
  t.scale_samples = std::max(Periods(kScaleApart_s, period_s), kScaleSamples);
  t.settling_filter = 1.0 - std::exp(-period_s / kSettlingBegin_s);
  t.settling_decay = std::exp(-period_s / kSettlingEnd_s);
  t.frozen_filter = 1.0 - std::exp(-1.0 / kChatter_periods);

  const double filter_s = std::max(3.0 * period_s, kBelowMode / mode_rad_s);
  const double count_N = t.mass_kg * a.count_m / (period_s * period_s);
  t.filter = std::min(1.0 - std::exp(-period_s / filter_s),
                      kNoiseShare * (t.external_N + t.friction_N) / std::max(count_N, 1e-12));
  const double sure_N = kSureOfLimit * a.force_limit_N;
  // A step rings by the motor's acceleration beyond that of a rigid axis; the filter passes so much of it.
  const double filtered_s = -period_s / std::log1p(-t.filter);
  t.ringing = t.mass_kg * t.screw_share_1_kg / std::hypot(1.0, mode_rad_s * filtered_s);
  // Half a swing: that of a square has come round. The mean of a constant comes out right in any case.
  t.swing_filter = 1.0 - std::exp(-period_s * mode_rad_s / std::numbers::pi);
  // A first-order filter passes f / |z - (1 - f)| and takes out (1 - f) |z - 1| / |z - (1 - f)|.
  const double least_mode_rad_s = mode_rad_s / std::sqrt(kSofterScrew * (1.0 + c.mass_error_rel));
  t.swing_periods = Periods(2.0 * std::numbers::pi / least_mode_rad_s, period_s);
  const double turned_rad = std::min(least_mode_rad_s * period_s, std::numbers::pi);
  t.swing_left = t.filter / ((1.0 - t.filter) * 2.0 * std::sin(0.5 * turned_rad));
  // A swing that fades within that many periods grows to pi times as many strokes of what stirs it.
  t.swing_gain =
      std::numbers::pi * kRinging_periods * (1.0 + c.mass_error_rel) * a.table_mass_kg / t.motor_kg;
  t.unexplained_rel =
      std::clamp(1.0 - (t.friction_N + t.external_N) / std::max(sure_N, 1e-9), 0.0, kMostUnexplained);
  t.delivery_N = c.reported_torque_error_rel * a.rated_force_N;
  UseSwing(a, c, period_s, t);
  t.windup_m = kWindupRoom * (a.force_limit_N + t.friction_N) / a.stiffness_N_m;
  return t;
}

}  // namespace contour
