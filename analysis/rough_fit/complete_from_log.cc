#include "analysis/rough_fit/complete_from_log.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/prediction_error/wrong_readings.h"
#include "analysis/rough_fit/falling_friction.h"
#include "analysis/rough_fit/rough_fit.h"
#include "config/config_error.h"
#include "config/number_text.h"

namespace contour::diagnosis {
namespace {

/// Relative deviations of what a first look says.
constexpr double kLevelSigma = 0.5, kSlopeSigma = 1.0;
/// [of the command's root mean square] What counts as friction that is not there.
constexpr double kNoFriction = 1e-3;
/// [of the Coulomb level, at the largest speed] The same of viscous friction.
constexpr double kNoSlope = 1e-2;
/// [of the largest speed, of the travel] Where nobody stated Stribeck velocity and bristle, and no lead says
/// how large the axis is.
constexpr double kStribeckSpeed = 0.01, kBristle = 1e-3;
/// [counts] A bristle that is shorter shows in no row.
constexpr double kBristleCounts = 2.0;
/// Constants from inertias that are worse known than this say nothing.
constexpr double kMostInertiaSigma = 0.3;
constexpr double kEndlessTurns = 2.0;
/// One stroke there and one back: a place that is come to more often is one of an axis that goes to and fro.
constexpr double kThereAndBack = 2.0;

/// Where nobody says whether the axis has a stroke. Turns that it comes back over say as much about what goes
/// with a stroke as strokes do, whether it could go on or not.
bool LooksEndless(const RoughFit& fit, const AxisLog& log, const StatedAxis& stated) {
  if (log.linear || stated.lead_m != 0.0 || stated.gear_ratio != 1.0 || !stated.open.contains("stroke") ||
      stated.endless || stated.to_and_fro)
    return false;
  return fit.travel > kEndlessTurns * 2.0 * std::numbers::pi && fit.visits <= kThereAndBack;
}

const RoughFit& Demanded(const RoughFit& fit, const AxisLog& log, const std::string& for_what) {
  if (fit.why_not.empty()) return fit;
  throw ConfigError({log.source + ": " + for_what + " is not stated, and the log does not say it: " +
                     fit.why_not + ". State it in the model, or record strokes at several speeds"});
}

void AmpereToUnit(AxisLog& log, StatedAxis& stated, std::vector<std::string>& notes) {
  const std::string key = log.linear ? "force_constant_N_A" : "torque_constant_Nm_A";
  double constant = stated.torque_constant;
  if (constant <= 0.0) {
    const RoughFit fit = FitRoughly(log, stated);
    Demanded(fit, log, key);
    if (!(fit.inertia > 0.0) || fit.inertia_sigma_rel > kMostInertiaSigma)
      throw ConfigError(
          {log.source + ": holds a current, and " + key +
           " is not stated. The log says it only through the stated inertia, and accelerates too "
           "little for that; state drive." +
           key + ", or record quick reversals"});
    constant = (stated.motor_inertia + stated.load_inertia) / fit.inertia;
    stated.open.insert("ampere");
    double& sigma = stated.sigma["inertia"];
    sigma = std::hypot(sigma > 0.0 ? sigma : kLevelSigma * 0.1, fit.inertia_sigma_rel);
    stated.torque_constant = constant;
    SayAmpere(stated, log.linear, notes);
  }
  for (double& u : log.command) u *= constant;
  stated.torque_constant = constant;
  log.in_ampere = false;
}

void Friction(const RoughFit& fit, const AxisLog& log, StatedAxis& stated) {
  StatedFriction& f = stated.friction;
  const auto open = [&](const char* name) { return stated.open.contains(name); };
  if (open("Fc")) {
    f.Fc_plus = f.Fc_minus = f.Fs_plus = f.Fs_minus = std::max(fit.coulomb, kNoFriction * fit.typical);
    stated.sigma["Fc"] = kLevelSigma;
  }
  if (open("s2")) {
    f.s2 = std::max(fit.viscous, kNoSlope * 0.5 * (f.Fc_plus + f.Fc_minus) / fit.max_speed);
    stated.sigma["s2"] = kSlopeSigma;
  }
  const bool no_lead = !log.linear && stated.lead_m == 0.0;
  if (open("vs") && no_lead) f.vs = kStribeckSpeed * fit.max_speed;
  if (!open("s0")) return;
  const double level = 0.5 * (f.Fc_plus + f.Fc_minus);
  double length = stated.lead_m > 0.0 || log.linear ? 2e-6 / stated.table_per_q : kBristle * fit.travel;
  if (no_lead) length = std::min(length, 2.5e-3);
  f.s0 = level / std::max(length, kBristleCounts * stated.position_step);
  stated.sigma["s0"] = kSlopeSigma;
}

}  // namespace

void SayAmpere(const StatedAxis& axis, bool linear, std::vector<std::string>& notes) {
  const std::string begin = "The log holds a current: ";
  std::erase_if(notes, [&](const std::string& note) { return note.starts_with(begin); });
  notes.push_back(begin + RoundedText(axis.torque_constant) + (linear ? " N/A" : " Nm/A") +
                  " makes the stated inertia that of the log. All forces stand on that; their ratios to each "
                  "other do not.");
}

std::vector<std::string> CompleteFromLog(AxisLog& log, StatedAxis& stated) {
  std::vector<std::string> notes;
  if (!log.note.empty()) notes.push_back(log.note);
  TakeOutWrongReadings(log, stated.position_step);
  if (log.in_ampere) AmpereToUnit(log, stated, notes);
  const bool frictionless = !(stated.friction.Fc_plus + stated.friction.Fc_minus > 0.0);
  const bool unknown = stated.open.contains("Fc") || stated.open.contains("s2");
  if (!unknown && !frictionless && !stated.open.contains("s0") && !stated.open.contains("vs") &&
      !stated.open.contains("stroke"))
    return notes;
  const RoughFit fit = FitRoughly(log, stated);
  if (unknown) {
    Demanded(fit, log, "friction");
    notes.emplace_back(
        "What the model leaves open of friction was taken from the log by least squares first.");
  }
  if (frictionless) {
    // A model of friction needs some: a thousandth of what moves the axis.
    StatedFriction& f = stated.friction;
    f.Fc_plus = f.Fc_minus = f.Fs_plus = f.Fs_minus = kNoFriction * (fit.typical > 0.0 ? fit.typical : 1.0);
    stated.open.insert("s0");
  }
  if (fit.why_not.empty()) Friction(fit, log, stated);
  if (LooksEndless(fit, log, stated)) {
    stated.endless = true;
    notes.push_back(
        "The axis makes " + RoundedText(fit.travel / (2.0 * std::numbers::pi)) +
        " turns, does not come back over most of them more than once, and no lead, gear or stroke is "
        "stated: it is taken to turn for ever, and no cause is looked for that goes with a stroke. Of an "
        "axis that goes to and fro state drive.endless: false, "
        "or its drive.stroke_mm.");
  }
  if (fit.why_not.empty() && stated.open.contains("Fc") && stated.open.contains("vs"))
    OpenFallingFriction(log, stated);
  return notes;
}

}  // namespace contour::diagnosis
