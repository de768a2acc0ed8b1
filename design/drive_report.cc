#include "design/drive_report.h"

#include <algorithm>
#include <cmath>

#include "analysis/text/format_text.h"

namespace contour {
namespace {

/// A median error above it is another loop than P and PI, or another axis.
constexpr double kMostError = 0.25;
/// The loop's bandwidth must be well inside what was measured.
constexpr double kSeenBeyond = 1.5;
/// A share that is less than this, or than three standard deviations, is none: friction differs on ramps.
constexpr double kLeastShare = 0.3;
constexpr double kCertain = 3.0;
/// Of a push's rms, beyond which hardly any is.
constexpr double kPeaks = 3.0;
/// Peaks of sensitivity between which a loop is well set.
constexpr double kCalm = 1.7, kSharp = 2.0;

/// How often the peaks of what flickering counts push by go into friction: above 1, friction holds nothing.
double KickOverFriction(const DriveReport& r) {
  return r.friction_N > 0.0 ? kPeaks * r.kick_N / r.friction_N : 0.0;
}

}  // namespace

std::string WhyUnusable(const DriveFit& fit) {
  if (!(fit.error_rel < kMostError))
    return FormatText(
        "its response differs from any loop of position P and velocity PI on the stated axis by %.0f %% in "
        "the "
        "median: commission the axis's model first (contour commission), and switch filters of the drive off",
        100.0 * fit.error_rel);
  const DriveLoopFigures f = FiguresOf(fit.axis, fit.loop, 1.0);
  if (f.bandwidth_Hz > 0.0 && fit.highest_Hz < kSeenBeyond * f.bandwidth_Hz)
    return FormatText(
        "it shows up to %.0f Hz only, and its bandwidth seems to be %.0f Hz: allow a longer way "
        "(--travel_mm)",
        fit.highest_Hz, f.bandwidth_Hz);
  return {};
}

double AdvisedShare(const DriveReport& r) {
  const double missing = r.acceleration.missing;
  const bool shows = std::abs(missing) > std::max(kLeastShare, kCertain * r.acceleration.std);
  if (!shows) return r.given_share;
  return std::clamp(std::round(10.0 * (r.given_share + missing)) / 10.0, 0.0, 1.0);
}

std::string Describe(const DriveReport& r) {
  const DriveLoop& l = r.fit.loop;
  const DriveLoopFigures& f = r.figures;
  const double mass_kg = r.fit.axis.motor_mass_kg + r.fit.axis.table_mass_kg;
  std::string text = FormatText(
      "axis %s, the loop of its drive: %zu frequencies up to %.0f Hz, model off by %.1f %% in the median\n"
      "  gains: velocity %.0f 1/s on %.3g kg, position %.0f 1/s, integral %.0f 1/s; a torque offset acts "
      "%.2f ms after the sample it is computed from\n"
      "  peak of sensitivity %.2f at %.0f Hz, phase margin %.0f deg, bandwidth %.0f Hz\n"
      "  stiffness at the table %.3g N/um at 1 Hz, %.3g at 10 Hz, least %.3g\n"
      "  %.3g N on the table through 4 ms: %.2f um",
      r.axis.c_str(), r.fit.lines, r.fit.highest_Hz, 100.0 * r.fit.error_rel, l.velocity_Ns_m / mass_kg,
      mass_kg, l.position_1_s, l.integral_1_s, 1e3 * l.offset_late_s, f.peak, f.peak_Hz, f.phase_margin_deg,
      f.bandwidth_Hz, f.stiffness_1Hz_N_um, f.stiffness_10Hz_N_um, f.least_stiffness_N_um, r.step_N,
      1e6 * f.step_peak_m);
  if (r.torque_mode_peak_m)
    text += FormatText("; with torques from here (cst, axes.%s.loop): %.2f um", r.axis.c_str(),
                       1e6 * *r.torque_mode_peak_m);
  if (r.kick_N > 0.0)
    text += FormatText("\n  counts of its encoder (%.3g nm) that flicker make it push by %.3g N rms",
                       1e9 * r.count_m, r.kick_N);
  if (r.kick_N > 0.0 && r.friction_N > 0.0)
    text += FormatText(", %.2f of Coulomb friction", r.kick_N / r.friction_N);
  text += FormatText("\n  of the torque of acceleration %.2f +- %.2f is missing\n", r.acceleration.missing,
                     r.acceleration.std);
  return text;
}

std::string Advice(const DriveReport& r) {
  std::string text;
  if (r.torque_mode_peak_m) {
    const bool drive = r.figures.step_peak_m < *r.torque_mode_peak_m;
    text += FormatText("advice: axes.%s.drive.mode: %s holds the table %.1f times as stiffly under a step\n",
                       r.axis.c_str(), drive ? "csp" : "cst",
                       drive ? *r.torque_mode_peak_m / r.figures.step_peak_m
                             : r.figures.step_peak_m / *r.torque_mode_peak_m);
  }
  if (const double share = AdvisedShare(r); share != r.given_share)
    text += FormatText(
        "advice: axes.%s.drive.csp_acceleration_share: %g; the drive does not feed all of the acceleration "
        "forward itself\n",
        r.axis.c_str(), share);
  if (const double over = KickOverFriction(r); over > 1.0)
    text += FormatText(
        "advice: %.3g times the counts per turn, or a velocity gain (or a filter of velocity, in the drive) "
        "that leaves %.2f of what it pushes by: now peaks of it are %.1f times friction, which gives way "
        "under an axis at rest, and is learnt from noise\n",
        std::exp2(std::ceil(std::log2(over))), 1.0 / over, over);
  if (r.figures.peak > kSharp)
    text += FormatText(
        "advice: lower the drive's gains to %.2f times theirs: a peak of sensitivity of %.2f leaves no room "
        "for a "
        "heavier table\n",
        r.figures.gain_room, r.figures.peak);
  else if (r.figures.peak < kCalm)
    text += FormatText(
        "advice: the drive's gains may rise to %.2f times theirs before the peak of sensitivity is 2, by "
        "this "
        "model\n",
        r.figures.gain_room);
  return text;
}

}  // namespace contour
