#include "analysis/diagnosis/rounds.h"

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/decision/choose.h"
#include "analysis/diagnosis/decision/evidence.h"
#include "analysis/diagnosis/decision/hypotheses.h"
#include "analysis/diagnosis/decision/own_noise.h"
#include "analysis/diagnosis/decision/superseded.h"
#include "analysis/diagnosis/quantification/detectable.h"
#include "analysis/diagnosis/quantification/jitter_cause.h"
#include "analysis/diagnosis/screening/screen.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"
#include "analysis/prediction_error/refit.h"

namespace contour::diagnosis {
namespace {

/// What goes on from round to round.
struct Rounds {
  Problem& problem;
  const Nominal& nominal;
  const DiagnoseOptions& options;
  Diagnosis& out;
  Accepted accepted = {};
  std::vector<std::string> tried = {};  ///< since the last cause was accepted, and refuted
  /// What could be found was stated for all kinds, with so many causes in the model.
  std::size_t stated_with = std::numeric_limits<std::size_t>::max();
  bool first = true, jitter_known = false;
  int further_orders = 0;
  int begun_anew = 0;               ///< from a base that lies lower
  std::vector<Cause> leading = {};  ///< known causes in place of a shape from outside the catalogue
};

enum class Next { kSameRound, kNextRound, kEnd };

/// What screening sees in addition to the accepted causes.
struct Seen {
  std::vector<Scored> scored;
  ScoreThreshold threshold;
  ScoreThreshold search;  ///< for the hypotheses that are to be fitted
  Jitter jitter;
  bool jitter_there = false;
};

bool Known(const std::string& kind, const Diagnosis& out) {
  return std::any_of(out.causes.begin(), out.causes.end(), [&](const Cause& c) { return c.kind == kind; });
}

bool Among(const std::vector<std::string>& kinds, std::string_view kind) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

void LeaveOut(const std::vector<std::string>& kinds, std::vector<Scored>& scored) {
  std::erase_if(scored, [&](const Scored& s) { return Among(kinds, s.effect->kind); });
}

/// Where one of them will be in the model next time around: their kinds; what could be found of the others
/// is not asked before. Else none.
std::vector<std::string> ThoseWithoutDoubt(const std::vector<Hypothesis>& hypotheses) {
  std::vector<std::string> out;
  if (hypotheses.empty() || hypotheses[0].no_fault || hypotheses[0].score < kAcceptance.no_chance_score)
    return out;
  for (const Hypothesis& r : hypotheses) out.push_back(r.effect().kind);
  return out;
}

/// Those that are promised most; where all of them come to nothing in the fit, the next ones.
std::vector<Hypothesis> HypothesesThatMayHold(const Problem& problem, const Fit& current,
                                              const std::vector<Scored>& scored,
                                              const ScoreThreshold& threshold,
                                              std::vector<std::string>& tried) {
  for (;;) {
    std::vector<Hypothesis> hypotheses = FitHypotheses(problem, current, scored, threshold, tried);
    if (hypotheses.empty() || MayHold(problem, hypotheses, threshold)) return hypotheses;
    if (!MorePromised(problem, scored, threshold, tried)) return {};
  }
}

void KeepFirst(const std::vector<Scored>& scored, Diagnosis& out) {
  for (const Scored& s : scored) {
    const bool known = std::any_of(out.candidates.begin(), out.candidates.end(),
                                   [&](const Candidate& c) { return c.kind == s.effect->kind; });
    if (!known)
      out.candidates.push_back({s.effect->kind, s.score, std::numeric_limits<double>::quiet_NaN(), false});
  }
}

Seen Look(Rounds& r) {
  Seen seen;
  seen.scored = Screen(r.problem, r.accepted.fit, r.nominal.catalogue);
  LeaveOut(r.options.exclude, seen.scored);
  seen.threshold = ScoreThresholdOf(r.problem, r.accepted, seen.scored, r.nominal.by_extras, r.options);
  seen.search = r.options.fit_above_chance ? ByChanceAlone(seen.threshold) : seen.threshold;
  seen.jitter = TestJitter(r.problem, r.accepted.fit);
  if (r.first) {
    KeepFirst(seen.scored, r.out);
    r.out.candidates.push_back({std::string(*CauseInScatter().name), ScoreOf(seen.jitter),
                                std::numeric_limits<double>::quiet_NaN(), false});
    r.out.threshold = Threshold(r.problem, seen.threshold);
    r.first = false;
  }
  seen.jitter_there = !r.jitter_known && !Among(r.options.exclude, *CauseInScatter().name) &&
                      ScoreOf(seen.jitter) > Threshold(r.problem, seen.threshold);
  return seen;
}

/// In addition to causes that are accepted: once more, for the others.
void KeepDetectable(const Problem& problem, const Fit& base, const Screened& screened,
                    const std::vector<std::string>& only, Diagnosis& out) {
  for (const auto& [kind, smallest] : SmallestDetectable(problem, base, screened, only))
    for (const auto& [name, size] : smallest) out.smallest_detectable[kind][name] = size;
  out.not_excited = NotExcited(out.smallest_detectable);
}

/// A cause that is there hides the others; once it is in the model they would be seen by less.
void StateDetectable(const Seen& seen, const std::vector<std::string>& only, Rounds& r) {
  if (r.stated_with == r.accepted.places.size()) return;
  if (only.empty()) r.stated_with = r.accepted.places.size();
  KeepDetectable(r.problem, r.accepted.fit, {seen.scored, seen.jitter, seen.threshold}, only, r.out);
}

Next EndWithJitter(const Seen& seen, Rounds& r) {
  if (seen.jitter_there) AcceptJitter(r.problem, r.nominal.fit, seen.jitter, r.out);
  return Next::kEnd;
}

/// What the score test likes best may come to nothing; the others had no turn yet.
Next TryOthers(const Seen& seen, Rounds& r) {
  if (!MorePromised(r.problem, seen.scored, seen.search, r.tried)) return Next::kEnd;
  r.problem.LearnNoise(r.accepted.fit.point);
  Rewhiten(r.problem, r.accepted.fit);
  return Next::kSameRound;
}

/// What is listed as not excited is not found either. Of what begins far from linear the smallest size says
/// little of a large one.
void EraseNotExcited(const Diagnosis& out, std::vector<Hypothesis>& hypotheses) {
  std::erase_if(hypotheses, [&](const Hypothesis& h) {
    return !h.gross && !Outside(h.effect().kind) && h.effect().start.empty() &&
           !out.smallest_detectable.contains(h.effect().kind);
  });
}

/// The first of the hypotheses, once it holds.
Next Take(const std::vector<Hypothesis>& hypotheses, const ScoreThreshold& threshold, Rounds& r) {
  r.tried.clear();
  const std::string kind = hypotheses[0].effect().kind;
  // A further order of what is known takes no other cause's place.
  const bool further = Known(kind, r.out) && r.further_orders++ < r.options.most_effects;
  if (Outside(kind)) KeepLeadingKnown(r.problem, r.accepted.fit, threshold, hypotheses, r.leading);
  AcceptFirst(r.problem, hypotheses, threshold, r.accepted, r.out);
  std::erase_if(r.out.causes.back().indistinguishable_from,
                [&](const std::string& other) { return Among(r.options.exclude, other); });
  if (Outside(kind)) return Next::kEnd;
  if (DropSuperseded(r.problem, threshold, r.accepted, r.out))
    r.stated_with = std::numeric_limits<std::size_t>::max();
  return further ? Next::kSameRound : Next::kNextRound;
}

Next OneRound(int round, Rounds& r) {
  Say(r.options, "candidates", 0.2 + 0.25 * round);
  const Seen seen = Look(r);
  Say(r.options, "candidate hypotheses", 0.3 + 0.25 * round);
  std::vector<Hypothesis> hypotheses =
      HypothesesThatMayHold(r.problem, r.accepted.fit, seen.scored, seen.search, r.tried);
  StateDetectable(seen, ThoseWithoutDoubt(hypotheses), r);
  if (hypotheses.empty()) return EndWithJitter(seen, r);
  EraseNotExcited(r.out, hypotheses);
  if (hypotheses.empty()) {
    const Next next = TryOthers(seen, r);
    return next == Next::kEnd ? EndWithJitter(seen, r) : next;
  }
  // Noise as the best candidate leaves it. Of a model that has a cause that holds it is not far from that.
  if (r.accepted.places.empty())
    LearnNoiseOfLikeliest(r.problem, hypotheses);
  else
    r.problem.LearnNoise(hypotheses[0].fit.point);
  Say(r.options, "candidate hypotheses under the noise that is left", 0.35 + 0.25 * round);
  if (FitAgain(r.problem, r.accepted.fit, hypotheses) && r.begun_anew++ < kHypotheses.most_turns) {
    // What they were to explain was where the base lay.
    r.tried.clear();
    r.problem.LearnNoise(r.accepted.fit.point);
    Rewhiten(r.problem, r.accepted.fit);
    return Next::kSameRound;
  }
  if (hypotheses[0].no_fault && hypotheses[0].score > Asked(r.problem, hypotheses[0], seen.threshold)) {
    // No cause of a deviation, but there; unless the model has it, others stand for it.
    r.accepted.fit = std::move(hypotheses[0].fit);
    r.tried.clear();
    return Next::kSameRound;
  }
  std::erase_if(hypotheses, [](const Hypothesis& hypothesis) { return hypothesis.no_fault; });
  if (hypotheses.empty() || hypotheses[0].given_up) return EndWithJitter(seen, r);
  TellEvidence(r.problem, r.accepted, seen.scored, hypotheses, seen.threshold, r.options);
  const Choice choice = ChooseFirst(r.problem, r.accepted.fit, seen.threshold, hypotheses);
  if (seen.jitter_there) {
    // A mean effect that the variance was about leaves none behind.
    const Jitter left = TestJitter(r.problem, hypotheses[0].fit);
    if (left.drop > kAcceptance.still_there_share * seen.jitter.drop &&
        (!choice.found || left.drop > choice.tested)) {
      AcceptJitter(r.problem, r.nominal.fit, left, r.out);
      r.jitter_known = true;
      r.tried.clear();
      return choice.found ? Next::kNextRound : Next::kEnd;
    }
  }
  if (choice.found) return Take(hypotheses, seen.threshold, r);
  GiveAnotherTurn(r.problem, hypotheses, seen.threshold, r.tried);
  return TryOthers(seen, r);
}

}  // namespace

RoundsResult AcceptInRounds(Problem& problem, const Nominal& nominal, const DiagnoseOptions& options,
                            Diagnosis& out) {
  Rounds r{problem, nominal, options, out};
  r.accepted.fit = nominal.fit;
  int round = 0;
  for (Next next = Next::kSameRound; next != Next::kEnd && round < options.most_effects;) {
    next = OneRound(round, r);
    if (next == Next::kNextRound) ++round;
  }
  // In addition to all that is in the model now, a shape from outside the catalogue among it.
  if (r.stated_with != r.accepted.places.size()) {
    std::vector<Scored> scored = Screen(problem, r.accepted.fit, nominal.catalogue);
    LeaveOut(options.exclude, scored);
    const Jitter jitter = TestJitter(problem, r.accepted.fit);
    const ScoreThreshold threshold =
        ScoreThresholdOf(problem, r.accepted, scored, nominal.by_extras, options);
    KeepDetectable(problem, r.accepted.fit, {scored, jitter, threshold}, {}, out);
  }
  return {std::move(r.accepted), round >= options.most_effects, std::move(r.leading)};
}

}  // namespace contour::diagnosis
