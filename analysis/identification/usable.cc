#include "analysis/identification/usable.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/text/format_text.h"

namespace contour::identify {
namespace {

/// Of all cycles. What was commanded in a lost one nobody knows, and each gap costs the simulation its state.
constexpr double kMostMissing = 0.01;
/// Standard deviations from the least of the cost.
constexpr double kMostUnsettled = 3.0;
/// Of friction, what goes with the motion and the model has not. Fed forward, a model leaves as much of the
/// wind-up that friction makes, F / K, and the best loops come down to less than a tenth of that.
constexpr double kMostUnexplained = 0.05;
/// Standard deviation of the stiffness; a catalogue has 0.4. What feeds the wind-up forward by a stiffness
/// that is less sure is no better with it.
constexpr double kLeastKnownStiffness = 0.15;
/// Of the motion by which the screw is seen, what an encoder's rounding may be.
constexpr double kMostRounding = 0.1;
/// Of a mass: what is known to a factor of two has as much, and needs no commissioning.
constexpr double kLeastKnownMass = 0.4;

std::string Numbers(const Identification& id) {
  for (const FittedParameter& p : id.fit.parameters) {
    if (!std::isfinite(p.value) || !std::isfinite(p.sigma))
      return p.key +
             " came out as no number: the record does not fit the model at all; are torque and position "
             "of one axis, and their signs right?";
    if (!(p.sigma > 0.0))
      return p.key +
             " has an interval of no width, which no measurement has: the record says nothing of it; "
             "commission with the whole plan of motions";
  }
  return {};
}

std::string Holes(const Identification& id) {
  if (id.missing_share <= kMostMissing) return {};
  return FormatText(
      "%.1f %% of the cycles are missing: give this computer less to do, or take the log of "
      "contourd --log and contour identify",
      100.0 * id.missing_share);
}

/// A screw that slow and quick forces do not agree about, or that the drive's reports hide.
std::string UnknownScrew(const Identification& id) {
  if (id.shaken.verdict != ShakenScrew::Verdict::kFound) return {};
  const double sigma = Sigma(id.fit.parameters, "screw_stiffness_N_um");
  if (!(sigma > kLeastKnownStiffness)) return {};
  return FormatText(
      "the screw's stiffness came out with a standard deviation of %.0f %%: what shaking shows of it does "
      "not "
      "fit together; something besides the screw swings (contour diagnose names it), or the torque is not "
      "all "
      "that acts",
      100.0 * sigma);
}

/// Rounding is no white noise: what it hides of a small motion the intervals do not know.
std::string HiddenByEncoder(const Identification& id) {
  const ShakenScrew& s = id.shaken;
  if (s.verdict != ShakenScrew::Verdict::kFound || !(s.moves_m > 0.0)) return {};
  // Root mean squares of the rounding and of the motion.
  if (id.encoder.step_m / std::sqrt(12.0) <= kMostRounding * s.moves_m / std::numbers::sqrt2) return {};
  return FormatText(
      "shaken at the screw's antiresonance (%.0f Hz) the motor moves by %.2f um, of which steps of its "
      "encoder of %.2f um show too little: what that tells of screw, table and bristle would be surer than "
      "it is; take an encoder, or a setting of the drive (0x608F, drive.encoder_counts_per_rev), with more "
      "counts a turn, or keep to the drive's own loop (drive.mode: csp) with the model as stated",
      s.antiresonance_Hz, 1e6 * s.moves_m, 1e6 * id.encoder.step_m);
}

/// A motion that does not tell the axis's masses says nothing that was not known before it.
std::string UnknownMasses(const Identification& id) {
  for (const FittedParameter& p : id.fit.parameters)
    if ((p.key == "motor_inertia_kgm2" || p.key == "table_mass_kg") && p.relative &&
        p.sigma > kLeastKnownMass)
      return FormatText(
          "%s came out with a standard deviation of %.0f %%, worse than a catalogue knows it: the axis was "
          "hardly accelerated or shaken; raise the limits, or commission in torque mode",
          p.key.c_str(), 100.0 * p.sigma);
  return {};
}

/// Size alone is none: noise of the torque may be larger than anything that the encoder has.
std::string Misfit(const Identification& id) {
  const UnexplainedForce& u = id.unexplained;
  if (u.structure_N <= kMostUnexplained * u.friction_N || u.structure_N <= u.noise_N) return {};
  return FormatText(
      "the model leaves a force of %.3g N unexplained that goes with the motion, %.0f %% of friction "
      "(noise: %.3g N): the axis has what the model has not, or the fit went astray; contour diagnose names "
      "it",
      u.structure_N, 100.0 * u.structure_N / u.friction_N, u.noise_N);
}

std::string Unsettled(const Identification& id) {
  if (id.fit.unsettled <= kMostUnsettled) return {};
  return FormatText(
      "the fit did not settle: it is still %.0f standard deviations from its best; begin with "
      "a model that is nearer, or commission again",
      id.fit.unsettled);
}

std::string Antiresonance(const Identification& id) {
  if (id.shaken.verdict != ShakenScrew::Verdict::kRigid) return {};
  const std::optional<ResponsePoint> dip = VisibleAntiresonance(id.shaken.response);
  if (!dip) return {};
  return FormatText(
      "the fit calls the axis rigid, but shaken it shows an antiresonance near %.0f Hz: what "
      "hides the screw from the fit (cogging, a part that swings) has to be found first; contour "
      "diagnose names it",
      dip->frequency_Hz);
}

}  // namespace

std::string WhyUnusable(const Identification& id) {
  for (const auto& why : {Numbers(id), Holes(id), Antiresonance(id), HiddenByEncoder(id), UnknownScrew(id),
                          UnknownMasses(id), Misfit(id), Unsettled(id)})
    if (!why.empty()) return why;
  return {};
}

std::string WhyNoScrew(const Identification& id, bool shaken) {
  if (id.shaken.verdict != ShakenScrew::Verdict::kNotSeen) return {};
  const std::string stiffness = id.wind_up.found ? "" : "the screw's stiffness, and ";
  const std::string why = shaken ? "the axis was shaken, and nothing of its screw showed: the chirp was too "
                                   "little for the friction, or turned the axis back; "
                                 : "nothing of the screw showed: " + id.shaken.why_not + "; ";
  return why + stiffness + "how much of the mass is the motor's, " + (id.wind_up.found ? "is" : "are") +
         " as open as before";
}

std::string WhyNoBeginning(const Identification& id) {
  if (id.shaken.verdict != ShakenScrew::Verdict::kFound) return "shaken, it showed no screw";
  for (const auto& why : {Numbers(id), Holes(id), Unsettled(id)})
    if (!why.empty()) return why;
  return {};
}

}  // namespace contour::identify
