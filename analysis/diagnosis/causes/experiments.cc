#include "analysis/diagnosis/causes/experiments.h"

#include <algorithm>
#include <cstdio>
#include <numbers>

#include "analysis/diagnosis/causes/catalogue.h"

namespace contour::diagnosis {
namespace {

std::string Number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

struct Sizes {
  std::string axis, stroke_mm, slow, low, middle, high, fast, torque_Nm;
};

/// The axis as its files name it; that of a file without names is x.
std::string NameOf(const Problem& p) {
  for (const std::string* name : {&p.stated.axis, &p.log.axis})
    if (!name->empty()) return *name;
  return "x";
}

Sizes SizesOf(const Problem& p) {
  const double stroke_mm = 2e3 * p.signals->half_stroke_m;
  const double fast = 1e3 * p.signals->max_speed * p.stated.table_per_q;
  // At the motor, whatever the log's coordinate is.
  const double to_motor =
      p.log.linear && p.stated.lead_m > 0.0 ? p.stated.lead_m / (2.0 * std::numbers::pi) : 1.0;
  const auto share = [&](double of_fast) { return Number(of_fast * fast); };
  return {NameOf(p),   Number(stroke_mm),
          share(0.02), share(0.1),
          share(0.3),  share(0.6),
          share(0.95), Number(std::max(0.2 * p.stated.rated, p.signals->coulomb) * to_motor)};
}

std::string Creep(const Sizes& s, const std::string& speeds, int repeats) {
  return "shape: creep\naxis: " + s.axis + "\nstroke_mm: " + s.stroke_mm + "\nvelocities_mm_s: [" + speeds +
         "]\nrepeats: " + std::to_string(repeats) + "\n";
}

std::string FiveSpeeds(const Sizes& s) {
  return s.slow + ", " + s.low + ", " + s.middle + ", " + s.high + ", " + s.fast;
}

std::string ThreeSpeeds(const Sizes& s) { return s.slow + ", " + s.middle + ", " + s.fast; }

}  // namespace

Experiment TorqueStepsFromRest(const Problem& problem, bool) {
  const Sizes s = SizesOf(problem);
  return {
      "Torque steps from rest in both directions, up to break-away: a constant torque is there at rest too, "
      "an asymmetry of friction only in motion.",
      "shape: torque_steps\naxis: " + s.axis + "\ntorques_Nm: [" + s.torque_Nm + ", -" + s.torque_Nm +
          "]\ntravel_mm: 2\nrepeats: 5\n"};
}

Experiment GrowingReversals(const Problem& problem, bool) {
  const Sizes s = SizesOf(problem);
  return {
      "Reversals of growing amplitude, from sticking to sliding, then creep in both directions: loops inside "
      "loops belong to presliding, a curve over the speed to Stribeck, a gap does not depend on the "
      "amplitude.",
      "shape: reversals\naxis: " + s.axis +
          "\namplitudes_mm: [0.002, 0.006, 0.02, 0.06, 0.2, 1]\nfrequency_hz: 1\ncycles: 4\n"};
}

Experiment FullStrokes(const Problem& problem, bool) {
  const Sizes s = SizesOf(problem);
  return {
      "Full strokes in both directions at two speeds, twice: friction changes its sign with the direction, a "
      "spring "
      "does not, an error of the lead shows on the scale alone.",
      Creep(s, s.middle + ", " + s.fast, 2)};
}

Experiment SameStretchAtThreeSpeeds(const Problem& problem, bool) {
  const Sizes s = SizesOf(problem);
  return {
      "The same part of the stroke in both directions at a slow, a middle and the highest speed: friction "
      "changes its sign with "
      "the direction, cogging keeps it, an error of the encoder grows with the square of the speed, a force "
      "from outside keeps its frequency.",
      Creep(s, ThreeSpeeds(s), 2)};
}

Experiment SameStrokesWarmAndCold(const Problem& problem, bool) {
  const Sizes s = SizesOf(problem);
  return {
      "The same strokes at the beginning, after warming up at speed, and after a pause to cool down: "
      "temperature comes back, time does not.",
      "sequence:\n  - {shape: creep, axis: " + s.axis + ", stroke_mm: " + s.stroke_mm +
          ", velocities_mm_s: [" + s.middle + ", " + s.fast +
          "], repeats: 3}\n  - {shape: hold, seconds: 60}\nrepeats: 3\n"};
}

Experiment FiveSpeedsAndPulses(const Problem& problem, bool) {
  const Sizes s = SizesOf(problem);
  return {
      "Strokes at five speeds, then pulses of high torque at low and at high speed: saturation and load go "
      "with the torque, viscosity with the speed. A torque constant needs one number measured otherwise, "
      "such as the inertia or the torque at a lever.",
      Creep(s, FiveSpeeds(s), 2) + "torque: {axis: " + s.axis +
          ", kind: pulses, amplitude_Nm: " + s.torque_Nm + ", period_s: 1}\n"};
}

Experiment ChirpWhileCreeping(const Problem& problem, bool) {
  const Sizes s = SizesOf(problem);
  return {
      "A chirp of torque while creeping, up to 400 Hz: a delay is phase alone, a lag falls off and ends at "
      "-90 degrees, an elastic coupling shows an antiresonance and then a resonance.",
      Creep(s, s.slow, 1) + "torque: {axis: " + s.axis + ", kind: chirp, amplitude_Nm: " + s.torque_Nm +
          ", frequency_min_hz: 10, frequency_max_hz: 400}\n"};
}

Experiment OtherAxisMoves(const Problem&, bool) {
  return {"Move the other axis while this one rests, then both at different rhythms.", ""};
}

Experiment SeveralConstantSpeeds(const Problem& problem, bool) {
  const Sizes s = SizesOf(problem);
  return {"Several constant speeds: the noise of the readings grows with the speed, nothing else does.",
          Creep(s, ThreeSpeeds(s), 1)};
}

Experiment GrowingReversalsOrNone(const Problem& problem, bool among_couplings) {
  return among_couplings ? Experiment{} : GrowingReversals(problem, false);
}

Experiment GrowingReversalsOrChirp(const Problem& problem, bool among_couplings) {
  return among_couplings ? ChirpWhileCreeping(problem, true) : GrowingReversals(problem, false);
}

Experiment DecidingExperiment(const Problem& problem, std::string_view kind,
                              const std::vector<std::string>& hypotheses) {
  const CauseDefinition& cause = CauseNamed(kind);
  if (cause.experiment == nullptr) return {};
  const bool among_couplings =
      std::any_of(hypotheses.begin(), hypotheses.end(),
                  [](const std::string& hypothesis) { return *CauseNamed(hypothesis).coupling; });
  return (*cause.experiment)(problem, among_couplings);
}

std::string ExperimentOn(const Problem& problem, Quantity quantity) {
  for (const CauseDefinition* c : AllCauses())
    if (*c->shows_more_of == quantity) return DecidingExperiment(problem, *c->name, {}).text;
  return "";
}

}  // namespace contour::diagnosis
