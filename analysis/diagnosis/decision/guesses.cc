#include "analysis/diagnosis/decision/guesses.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/decision/tested_score.h"
#include "analysis/diagnosis/screening/full_size.h"
#include "analysis/diagnosis/screening/gross_sliding.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"
#include "analysis/prediction_error/common_factor.h"

namespace contour::diagnosis {

FitEffort WorthFrom(const Fit& current, FitEffort effort, double share) {
  effort.share_enough = share;
  effort.from = current.cost;
  return effort;
}

InitialGuess Near(const Problem& problem, const Fit& current, const Scored& s) {
  Point start = current.point;
  start.effects.push_back(s.effect);
  std::vector<double> a(s.effect->steps.size(), 0.0);
  for (std::size_t i = 0; i < s.effect->tested; ++i) a[i] = s.amplitude(static_cast<Eigen::Index>(i));
  for (std::size_t i = 0; i < a.size() && !s.effect->low.empty(); ++i)
    a[i] = std::clamp(a[i], s.effect->low[i], s.effect->high[i]);
  // What the effect does the base need not do any more: the same model, and no deviation.
  const std::vector<std::size_t> freed = FreedTerms(problem, s.effect->kind);
  for (std::size_t i = 0; i < freed.size() && i < a.size(); ++i) start.base[freed[i]] -= a[i];
  start.amplitudes.push_back(std::move(a));
  if (s.effect->common_factor) TakeOver(problem, std::log1p(start.amplitudes.back()[0]), start);
  return {std::move(start), WorthFrom(current, kEfforts.quick, kScreening.negligible_share), &current};
}

std::string FamilyOf(const Effect& effect) {
  const CauseDefinition& cause = CauseNamed(effect.kind);
  return effect.kind + (cause.family == nullptr ? "" : std::string((*cause.family)(effect)));
}

bool Among(const std::vector<std::string>& families, const Scored& s) {
  return std::find(families.begin(), families.end(), FamilyOf(*s.effect)) != families.end();
}

namespace {

/// Far from linear: the kind's whole grid at full size shows where to begin. A coupling that every screw has
/// begins next to the best, which may be a softer one that stands for it.
std::vector<InitialGuess> Far(const Problem& problem, const Fit& current, const std::string& kind,
                              const std::vector<Scored>& scored) {
  GridPoint best, stiff;
  const bool coupling = CauseNamed(kind).coupling && !problem.nominal.two_inertia;
  for (GridPoint& p : FullSize(problem, current, kind, scored)) {
    GridPoint& of = coupling && p.point.effects.back()->order > NoFault_Hz(problem) ? stiff : best;
    if (p.cost < of.cost) of = std::move(p);
  }
  std::vector<InitialGuess> out;
  // The base's sensitivities serve until they lead astray.
  FitEffort effort = WorthFrom(current, kEfforts.far, kScreening.negligible_share);
  effort.hopeless_above = current.cost;
  for (GridPoint* p : {&best, &stiff})
    if (std::isfinite(p->cost)) out.push_back({std::move(p->point), effort, &current});
  return out;
}

/// Next to each guess, those of kinds that do the same to an axis that slides. Which of them the score test
/// likes best also depends on the bristle's numbers, which are not fitted yet.
void GuessSameInSliding(const Problem& problem, const Fit& current, const std::vector<Scored>& scored,
                        const ScoreThreshold& threshold, std::vector<std::string>& tried,
                        std::vector<InitialGuess>& guesses) {
  const std::size_t first = guesses.size();
  for (std::size_t i = 0; i < first; ++i)
    for (const Scored& s : scored) {
      if (!SameInSliding(guesses[i].point.effects.back()->kind, s.effect->kind) || Among(tried, s) ||
          !Promising(problem, s, threshold))
        continue;
      tried.push_back(FamilyOf(*s.effect));
      guesses.push_back(Near(problem, current, s));
    }
}

}  // namespace

std::vector<InitialGuess> NextGuesses(const Problem& problem, const Fit& current,
                                      const std::vector<Scored>& scored, const ScoreThreshold& threshold,
                                      std::vector<std::string>& tried, double& most) {
  std::vector<InitialGuess> guesses;
  const std::vector<std::string> before = tried;
  std::size_t fitted = 0, looked_at = 0;
  bool outside = !before.empty(), promising = false;
  most = 0.0;
  for (const Scored& s : scored)
    if (!Outside(s.effect->kind) && !Among(before, s)) most = std::max(most, s.drop);
  for (const Scored& s : scored) {
    if (Outside(s.effect->kind)) {
      if (!outside && s.drop > most) guesses.push_back(Near(problem, current, s));
      outside = true;
    } else {
      // Evidence in the priors is small compared with what lies in the residual, and as good.
      const bool by_priors = InBase(problem, s.effect->kind) && Promising(problem, s, threshold);
      if (!by_priors && (fitted >= kHypotheses.most_kinds || looked_at >= MostLookedAt() ||
                         s.drop < kScreening.little_share * most))
        continue;
      if (Among(tried, s)) continue;
      tried.push_back(FamilyOf(*s.effect));
      ++looked_at;
      if (!s.effect->start.empty()) {
        if (!Promising(problem, s, threshold)) continue;
        std::vector<InitialGuess> far = Far(problem, current, s.effect->kind, scored);
        if (far.empty() && by_priors) far.push_back(Near(problem, current, s));
        if (far.empty()) continue;
        promising = true;
        std::move(far.begin(), far.end(), std::back_inserter(guesses));
        if (!by_priors) ++fitted;
        continue;
      }
      guesses.push_back(Near(problem, current, s));
      if (!by_priors) ++fitted;
    }
    promising = promising || Promising(problem, s, threshold);
  }
  GuessSameInSliding(problem, current, scored, threshold, tried, guesses);
  if (!promising) guesses.clear();
  return guesses;
}

std::vector<InitialGuess> OtherPlaces(const Problem& problem, const Fit& current,
                                      const std::vector<Scored>& scored,
                                      std::span<const Hypothesis> hypotheses) {
  std::vector<InitialGuess> guesses;
  for (const Hypothesis& r : hypotheses) {
    // A wave of another order is another cause; of what is far from linear the whole grid was looked at.
    if (!r.implausible || r.effect().wave || !r.effect().start.empty()) continue;
    const std::string family = FamilyOf(r.effect());
    const auto fitted = [&](const Scored& s) {
      return std::any_of(hypotheses.begin(), hypotheses.end(),
                         [&](const Hypothesis& o) { return &o.effect() == s.effect.get(); });
    };
    const auto next = std::find_if(scored.begin(), scored.end(), [&](const Scored& s) {
      return FamilyOf(*s.effect) == family && !fitted(s);
    });
    if (next != scored.end()) guesses.push_back(Near(problem, current, *next));
  }
  return guesses;
}

std::vector<InitialGuess> Mirrored(const Problem& problem, const Fit& current,
                                   const std::vector<Scored>& scored,
                                   std::span<const Hypothesis> hypotheses) {
  std::vector<InitialGuess> guesses;
  for (const Hypothesis& r : hypotheses) {
    if (!AddsCoupling(problem, r) || r.implausible || r.no_fault || !std::isfinite(r.fit.cost)) continue;
    const AxisModel m = problem.Build(r.fit.point);
    const double seen_Hz =
        std::sqrt(m.stiffness * (1.0 / m.motor_inertia + 1.0 / m.load_inertia)) / (2.0 * std::numbers::pi);
    const double above_Hz = 1.0 / problem.log.period_s - seen_Hz;
    if (!(above_Hz > NoFault_Hz(problem))) continue;
    // How much of the inertia is behind the coupling shows only in the height of the resonance, where its
    // damping shows, too: the fit begins with as much behind it as before it.
    const double share = 1.0 / 2.0;
    const double clamped_Hz = above_Hz * std::sqrt(1.0 - share);
    const auto off = [&](const Scored& s) { return std::fabs(std::log(s.effect->order / clamped_Hz)); };
    const Scored* nearest = nullptr;
    for (const Scored& s : scored)
      if (s.effect->kind == r.effect().kind && (nearest == nullptr || off(s) < off(*nearest))) nearest = &s;
    if (nearest == nullptr) continue;
    Point point = r.fit.point;
    point.effects.back() = nearest->effect;
    std::vector<double>& a = point.amplitudes.back();
    // The damping that makes the resonance as wide, in Hz, as it is seen.
    a = {share, std::log(clamped_Hz / nearest->effect->order), a[2] + std::log(seen_Hz / above_Hz)};
    for (std::size_t i = 0; i < a.size(); ++i)
      a[i] = std::clamp(a[i], nearest->effect->low[i], nearest->effect->high[i]);
    guesses.push_back(
        {std::move(point), WorthFrom(current, kEfforts.far, kScreening.negligible_share), &current});
  }
  return guesses;
}

}  // namespace contour::diagnosis
