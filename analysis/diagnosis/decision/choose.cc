#include "analysis/diagnosis/decision/choose.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "analysis/diagnosis/adequacy/remaining_structure.h"
#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/decision/chi_square.h"
#include "analysis/diagnosis/decision/held_out.h"
#include "analysis/diagnosis/decision/tested_score.h"
#include "analysis/diagnosis/screening/gross_sliding.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"
#include "analysis/diagnosis/tuning/statistics.h"

namespace contour::diagnosis {
namespace {

/// Beyond chance, in deviations, at the asked rate over the number of kinds.
double BeyondChance(double rate) {
  return std::sqrt(ChiSquareQuantile(1, 2.0 * rate / static_cast<double>(AllCauses().size())));
}

/// Whether the gain on halves that the fit has not seen is above zero beyond chance.
bool GainsBeyondChance(const Cause& cause, double rate) {
  return cause.heldout_gain > BeyondChance(rate) / kNormal95 * (cause.heldout_gain - cause.heldout_gain_low);
}

/// Whether a cause on the scale foresees it where it comes to the same places. A scale wanders by more than
/// many an error of a lead: what it reads may say so, or the rows as multiples of the noise that they have.
bool ForeseesTheScale(const Problem& problem, const Fit& current, const Hypothesis& r, bool gains_unseen,
                      double rate) {
  return gains_unseen || !FoldsShareTheStroke(problem) ||
         Consistency(problem, current, r.fit, LeftOut::kNeighbours) > BeyondChance(rate);
}

bool Holds(const Problem& problem, const Fit& current, const Hypothesis& r, double tested,
           const ScoreThreshold& threshold) {
  // From outside the catalogue only what is beyond doubt.
  const double least = Asked(problem, r, threshold);
  if (tested <= (Outside(r.effect().kind) ? least + kHypotheses.new_noise_score : least)) return false;
  // A force of any shape follows slow noise, and a scale that wanders: it has to show without a shape, too. A
  // level of friction does not: noise has no direction.
  if (Outside(r.effect().kind) && !r.effect().force.empty()) {
    const RemainingStructure most = FindStructure(problem, current, threshold.rate)[0];
    if (!(most.score > most.asked)) return false;
  }
  // What does harm in the half of the log that it was not fitted on is no cause. A factor on all forces and
  // on the torque moves nothing that it could harm.
  const CauseDefinition& definition = CauseNamed(r.effect().kind);
  bool gains_unseen = false;
  if (!definition.common_factor) {
    Cause cause;
    std::vector<BlockGain> blocks;
    const bool as_asked = HeldOutGain(problem, current, r.fit, definition.judged_at_scale, cause, blocks);
    if (cause.heldout_gain_high < 0.0) return false;
    gains_unseen = as_asked && GainsBeyondChance(cause, threshold.rate);
    // Nor is a shape that nobody knows beyond doubt where it foresees nothing; nor on a scale, which wanders,
    // any shape over the stroke, where it could foresee something.
    if (Outside(r.effect().kind) && !gains_unseen) return false;
    if (definition.judged_at_scale && !ForeseesTheScale(problem, current, r, gains_unseen, threshold.rate))
      return false;
  }
  // What a base parameter does already shows in the priors.
  if (InBase(problem, r.effect().kind)) return true;
  if (Consistency(problem, current, r.fit, LeftOut::kBlock) > kAcceptance.consistency) return true;
  // Left out, the only stroke that shows a base parameter may take it far, to first order. Where chance is
  // out of the question, by the score or by the gain on the halves that were not fitted on, it is enough that
  // the drop does not come from one event.
  return (gains_unseen || tested > kAcceptance.no_chance_score) &&
         Consistency(problem, current, r.fit, LeftOut::kNothing) > std::numbers::sqrt2;
}

/// Whether a shape that nobody knows foresees more than the first known hypothesis that holds. A force of
/// time has a constant in it, and a friction of time what grows with the speed on the average.
bool ForeseesMore(const Problem& problem, const Fit& current, const std::vector<Hypothesis>& hypotheses,
                  const Hypothesis& shape, const ScoreThreshold& threshold) {
  for (const Hypothesis& r : hypotheses) {
    if (r.given_up || Outside(r.effect().kind)) continue;
    if (!Holds(problem, current, r, TestedScore(problem, current, r), threshold)) continue;
    Cause cause;
    std::vector<BlockGain> blocks;
    HeldOutGain(problem, r.fit, shape.fit, false, cause, blocks);
    return GainsBeyondChance(cause, threshold.rate);
  }
  return true;
}

/// The hypothesis itself, or a number of the base behind it that the log says more about, where that is not
/// for the same reason: a score is worth what its scatter from block to block leaves of it.
std::size_t SurerNumber(const Problem& problem, const Fit& current, const std::vector<Hypothesis>& hypotheses,
                        std::size_t holds, const ScoreThreshold& threshold, double& tested) {
  std::size_t surest = holds;
  for (std::size_t i = holds + 1; i < hypotheses.size(); ++i) {
    if (!InBase(problem, hypotheses[i].effect().kind)) continue;
    const double score = TestedScore(problem, current, hypotheses[i]);
    if (score <= tested || !Holds(problem, current, hypotheses[i], score, threshold) ||
        !ExplainsSomethingElse(problem, hypotheses[holds].fit, hypotheses[i]))
      continue;
    surest = i;
    tested = score;
  }
  return surest;
}

}  // namespace

double Asked(const Problem& problem, const Hypothesis& r, const ScoreThreshold& threshold) {
  // Nothing is left of what nobody has found yet.
  const ScoreScale score_scale = threshold.accepted > 0 ? ScoreScaleOf(problem, r.fit) : ScoreScale{};
  return Threshold(problem, threshold, r.effect(), score_scale);
}

bool ExplainsSomethingElse(const Problem& problem, const Fit& other, const Hypothesis& r) {
  const SharedEffect& effect = r.fit.point.effects.back();
  if (!effect->signals && !InBase(problem, effect->kind)) return false;
  return ScoreEffects(problem, other, {effect})[0].drop >
         kAcceptance.still_there_share * (r.score + Penalty(*effect));
}

Choice ChooseFirst(const Problem& problem, const Fit& current, const ScoreThreshold& threshold,
                   std::vector<Hypothesis>& hypotheses) {
  Choice choice;
  for (std::size_t i = 0; i < hypotheses.size() && !choice.found; ++i) {
    if (hypotheses[i].given_up) continue;
    // Far behind the best, only what explains something with the best in the model, too: the best may be
    // refused and still be what moves the others.
    if (i > 0 && hypotheses[i].score < kHypotheses.may_matter_share * hypotheses[0].score &&
        !ExplainsSomethingElse(problem, hypotheses[0].fit, hypotheses[i]))
      continue;
    const double score = TestedScore(problem, current, hypotheses[i]);
    if (i == 0) choice.tested = score;
    hypotheses[i].refused = !Holds(problem, current, hypotheses[i], score, threshold);
    if (!hypotheses[i].refused && Outside(hypotheses[i].effect().kind))
      hypotheses[i].refused = !ForeseesMore(problem, current, hypotheses, hypotheses[i], threshold);
    if (hypotheses[i].refused) continue;
    choice.found = true;
    choice.tested = score;
    const std::size_t chosen = SurerNumber(problem, current, hypotheses, i, threshold, choice.tested);
    if (chosen == 0) continue;
    std::rotate(hypotheses.begin(), hypotheses.begin() + static_cast<std::ptrdiff_t>(chosen),
                hypotheses.begin() + static_cast<std::ptrdiff_t>(chosen) + 1);
    hypotheses[0].fit = FitOn(problem, std::move(hypotheses[0].fit), QuickToTheEnd());
    hypotheses[0].score = DropOf(problem, current, hypotheses[0].fit) - Penalty(hypotheses[0].effect());
  }
  return choice;
}

}  // namespace contour::diagnosis
