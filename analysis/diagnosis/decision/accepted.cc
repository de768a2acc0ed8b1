#include "analysis/diagnosis/decision/accepted.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "analysis/diagnosis/causes/parameters.h"
#include "analysis/diagnosis/decision/choose.h"
#include "analysis/diagnosis/decision/held_out.h"
#include "analysis/diagnosis/decision/same_levels.h"
#include "analysis/diagnosis/decision/same_timing.h"
#include "analysis/diagnosis/screening/gross_sliding.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"

namespace contour::diagnosis {
namespace {

/// A bristle that bends by less than two counts of the encoder shows in no row.
bool BristleShows(const Problem& problem, const Fit& fit) {
  const StatedFriction f = problem.Build(fit.point).friction;
  return f.Fc_plus > 2.0 * problem.stated.position_step * f.s0;
}

/// Kinds that do the same to an axis whose bristle does not show, or whose starts from rest do not tell.
void AddSameInSliding(const Problem& problem, const Fit& fit, double rate, Cause& cause) {
  const bool shows = BristleShows(problem, fit);
  std::vector<std::string>& others = cause.indistinguishable_from;
  for (const CauseDefinition* c : AllCauses())
    if (SameInSliding(cause.kind, *c->name) &&
        std::find(others.begin(), others.end(), *c->name) == others.end() &&
        (!shows || SameLevels(problem, fit, *c->name, rate)))
      others.emplace_back(*c->name);
}

/// Refused for how its drop scatters, and no more: it does the same to an axis that slides as what was taken
/// in its place, and explains more.
bool RefusedButTheSame(const Hypothesis& best, const Hypothesis& r) {
  return r.refused && r.score > best.score && SameInSliding(best.effect().kind, r.effect().kind);
}

/// What the hypotheses scored, and which of them cannot be told from the first.
void NoteHypotheses(const Problem& problem, const std::vector<Hypothesis>& hypotheses,
                    const ScoreThreshold& threshold, const Accepted& accepted, Cause& cause, Diagnosis& out) {
  const Hypothesis& best = hypotheses[0];
  const double alike =
      FrictionModelMismatch(problem, accepted.fit) ? kScreening.little_share : kAcceptance.alike_share;
  for (const Hypothesis& r : hypotheses) {
    const std::string& kind = r.effect().kind;
    for (Candidate& c : out.candidates)
      if (c.kind == kind && std::isnan(c.refitted)) {
        c.refitted = r.score;
        c.accepted = &r == &best;
      }
    // What would not have been accepted alone explains too little to be the cause.
    if (&r == &best || (r.refused && !RefusedButTheSame(best, r)) || r.given_up || Outside(kind) ||
        !(r.score > Asked(problem, r, threshold)))
      continue;
    const double less = std::max(AlikeScore(), alike * best.score);
    const bool same = r.score > best.score - less && !ExplainsSomethingElse(problem, best.fit, r) &&
                      !ExplainsSomethingElse(problem, r.fit, best);
    if (same || SameTiming(problem, best, r, less)) cause.indistinguishable_from.push_back(kind);
  }
  AddSameInSliding(problem, best.fit, threshold.rate, cause);
}

}  // namespace

ScoreThreshold ScoreThresholdOf(const Problem& problem, const Accepted& accepted,
                                std::span<const Scored> scored, double by_extras,
                                const DiagnoseOptions& options) {
  ScoreThreshold threshold =
      SignFlips(scored, options.false_alarm_rate, options.seed, StatedOffDrop() * by_extras);
  threshold.accepted = static_cast<int>(accepted.places.size());
  threshold.leakage =
      accepted.leakage +
      (FrictionModelMismatch(problem, accepted.fit) ? kScreening.little_share * accepted.in_presliding : 0.0);
  threshold.leakage_of_kind = accepted.leakage_of_kind;
  return threshold;
}

double ScatterOfLast(const Problem& problem, const Fit& fit) {
  return OverdispersionOfLast(problem, fit) * kAcceptance.few_strokes * kAcceptance.few_strokes;
}

void KeepLeadingKnown(const Problem& problem, const Fit& current, const ScoreThreshold& threshold,
                      const std::vector<Hypothesis>& hypotheses, std::vector<Cause>& leading) {
  for (const Hypothesis& h : hypotheses) {
    const std::string& kind = h.effect().kind;
    if (h.given_up || h.refused || Outside(kind) || !(h.score > Asked(problem, h, threshold))) continue;
    Cause cause;
    cause.kind = kind;
    cause.part_of_it = true;
    cause.log_evidence_gain = 0.5 * h.score;
    std::vector<BlockGain> blocks;
    HeldOutGain(problem, current, h.fit, CauseNamed(kind).judged_at_scale, cause, blocks);
    if (cause.heldout_gain_low <= 0.0) continue;
    Fit scattered = h.fit;
    scattered.covariance *= ScatterOfLast(problem, h.fit);
    DescribeEffect(problem, scattered, h.fit.point.effects.size() - 1, cause);
    leading.push_back(std::move(cause));
    return;
  }
}

void AcceptFirst(const Problem& problem, const std::vector<Hypothesis>& hypotheses,
                 const ScoreThreshold& threshold, Accepted& accepted, Diagnosis& out) {
  const Hypothesis& best = hypotheses[0];
  Cause cause;
  cause.kind = best.effect().kind;
  cause.log_evidence_gain = 0.5 * best.score;
  NoteHypotheses(problem, hypotheses, threshold, accepted, cause, out);
  const Experiment experiment = DecidingExperiment(problem, cause.kind, cause.indistinguishable_from);
  cause.deciding_experiment = experiment.text;
  cause.deciding_program = experiment.program;
  accepted.scatter.push_back(ScatterOfLast(problem, best.fit));
  std::vector<BlockGain> blocks;
  HeldOutGain(problem, accepted.fit, best.fit, CauseNamed(cause.kind).judged_at_scale, cause, blocks);
  if (out.causes.empty()) out.blocks = blocks;
  out.causes.push_back(std::move(cause));
  accepted.places.push_back(best.fit.point.effects.size() - 1);
  const std::string& kind = best.effect().kind;
  accepted.explained += best.score;
  if (CauseNamed(kind).takes_up_mismatch) accepted.in_presliding = best.score;
  accepted.leakage += kThreshold.leakage_share * best.score;
  accepted.leakage_of_kind[kind] += kThreshold.leakage_share * best.score;
  accepted.fit = best.fit;
}

Cause TakeBack(std::size_t in_fit, Accepted& accepted, Diagnosis& out) {
  const auto at = static_cast<std::ptrdiff_t>(in_fit);
  const std::size_t place = accepted.places[in_fit];
  accepted.places.erase(accepted.places.begin() + at);
  accepted.scatter.erase(accepted.scatter.begin() + at);
  if (Point& slow = accepted.by_slow_observer; place < slow.effects.size()) {
    slow.effects.erase(slow.effects.begin() + static_cast<std::ptrdiff_t>(place));
    slow.amplitudes.erase(slow.amplitudes.begin() + static_cast<std::ptrdiff_t>(place));
  }
  for (std::size_t& p : accepted.places)
    if (p > place) --p;
  auto cause = out.causes.begin();
  for (std::size_t before = in_fit;; ++cause) {
    if (CauseNamed(cause->kind).in_scatter_only) continue;  // not in the fit
    if (before-- == 0) break;
  }
  if (cause == out.causes.begin()) out.blocks.clear();  // were of the first
  Cause taken = std::move(*cause);
  out.causes.erase(cause);
  // Of waves several orders may be there.
  if (std::any_of(out.causes.begin(), out.causes.end(), [&](const Cause& c) { return c.kind == taken.kind; }))
    return taken;
  accepted.leakage_of_kind.erase(taken.kind);
  for (Candidate& c : out.candidates)
    if (c.kind == taken.kind) c.accepted = false;
  return taken;
}

}  // namespace contour::diagnosis
