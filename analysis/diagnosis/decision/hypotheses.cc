#include "analysis/diagnosis/decision/hypotheses.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>
#include <utility>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/decision/base_there.h"
#include "analysis/diagnosis/decision/gross_causes.h"
#include "analysis/diagnosis/decision/guesses.h"
#include "analysis/diagnosis/decision/instants.h"
#include "analysis/diagnosis/decision/long_delays.h"
#include "analysis/diagnosis/decision/tested_score.h"
#include "analysis/diagnosis/screening/gross_sliding.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"
#include "analysis/prediction_error/refit.h"

namespace contour::diagnosis {
namespace {

/// Catalogue first, the best first, those given up at the end; what lies outside it comes first only where it
/// explains far more.
void Sort(std::vector<Hypothesis>& hypotheses) {
  std::stable_sort(hypotheses.begin(), hypotheses.end(), [](const Hypothesis& a, const Hypothesis& b) {
    if (a.given_up != b.given_up) return b.given_up;
    const bool x = Outside(a.effect().kind), y = Outside(b.effect().kind);
    return x != y ? y : a.score > b.score;
  });
  const auto outside = std::find_if(hypotheses.begin(), hypotheses.end(), [](const Hypothesis& r) {
    return !r.given_up && Outside(r.effect().kind);
  });
  if (outside == hypotheses.end() || outside == hypotheses.begin()) return;
  if (outside->score >
      (1.0 + kHypotheses.may_matter_share) * std::max(0.0, hypotheses[0].score) + kHypotheses.new_noise_score)
    std::rotate(hypotheses.begin(), outside, outside + 1);
}

/// Of each kind the best only; sorted before.
void OneOfEach(std::vector<Hypothesis>& hypotheses) {
  std::vector<Hypothesis> out;
  for (Hypothesis& r : hypotheses)
    if (std::none_of(out.begin(), out.end(), [&](const Hypothesis& o) {
          return o.effect().kind == r.effect().kind && o.no_fault == r.no_fault;
        }))
      out.push_back(std::move(r));
  hypotheses = std::move(out);
}

/// Whether the score test promises enough to be tested in addition to the best; it says nothing about what is
/// far from linear.
bool MayMatter(const std::vector<Scored>& scored, const Hypothesis& r, double best) {
  if (!r.effect().start.empty()) return true;
  return std::any_of(scored.begin(), scored.end(), [&](const Scored& s) {
    return s.effect->kind == r.effect().kind &&
           s.drop > kHypotheses.may_matter_share * best - kHypotheses.new_noise_score;
  });
}

/// Where the stated numbers went too far, the fit may be in a wrong place: once more from where they are
/// stated. One after the other, for the memory.
void FitAllFromStated(const Problem& problem, const Fit& current, const std::vector<Scored>& scored,
                      std::vector<Hypothesis>& hypotheses) {
  double best = 0.0;
  for (Hypothesis& r : hypotheses) {
    if (Outside(r.effect().kind)) continue;
    if (!InBase(problem, r.effect().kind) && !MayMatter(scored, r, best)) continue;
    double worth = std::numeric_limits<double>::infinity();
    if (!InBase(problem, r.effect().kind))
      worth = current.cost - Penalty(r.effect()) - kHypotheses.may_matter_share * best;
    if (FitFromStated(problem, r.fit, kEfforts.far, worth)) Judge(problem, current, r);
    best = std::max(best, r.score);
  }
}

/// Of the same cause, begun elsewhere: what least squares said of it stays true.
void TakeBetter(Hypothesis anew, Hypothesis& r) {
  anew.gross = r.gross;
  if (anew.score > r.score) r = std::move(anew);
}

/// Where the linear estimate lies across a ridge of the cost, a fit that begins there ends above the base.
/// From where the effect is absent it cannot: once more, for those that keep little of what the score test
/// promises.
void FitFromAbsent(const Problem& problem, const Fit& current, const std::vector<Scored>& scored,
                   std::vector<Hypothesis>& hypotheses) {
  std::vector<std::size_t> again;
  std::vector<InitialGuess> guesses;
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    const Effect& e = hypotheses[i].effect();
    if (!e.start.empty() || InBase(problem, e.kind) || Outside(e.kind)) continue;
    const auto s =
        std::find_if(scored.begin(), scored.end(), [&](const Scored& one) { return one.effect.get() == &e; });
    if (s == scored.end() ||
        hypotheses[i].score > kHypotheses.half_share * (s->drop - Penalty(e)) - kHypotheses.new_noise_score)
      continue;
    Point absent = current.point;
    absent.effects.push_back(s->effect);
    absent.amplitudes.emplace_back(e.steps.size(), 0.0);
    again.push_back(i);
    guesses.push_back(
        {std::move(absent), WorthFrom(current, kEfforts.far, kScreening.negligible_share), &current});
  }
  std::vector<Fit> fits = FitPoints(problem, std::move(guesses));
  for (std::size_t i = 0; i < again.size(); ++i) {
    Hypothesis anew{std::move(fits[i])};
    Judge(problem, current, anew);
    TakeBetter(std::move(anew), hypotheses[again[i]]);
  }
}

/// Those below a share of the best one's score, never the first; sorted before and after.
void GiveUpFarBehind(const Problem& problem, double share, std::vector<Hypothesis>& hypotheses) {
  for (Hypothesis& r : hypotheses) {
    if (&r == hypotheses.data() || r.given_up || InBase(problem, r.effect().kind)) continue;
    r.given_up = r.score < share * std::max(0.0, hypotheses[0].score) - kHypotheses.new_noise_score;
    if (!r.given_up) continue;
    Fit left;
    left.point = std::move(r.fit.point);
    left.cost = r.fit.cost;
    left.promised = r.fit.promised;
    r.fit = std::move(left);
  }
  Sort(hypotheses);
}

/// Those behind `before` were begun by least squares: of each kind the better fit stays, and one that had
/// none has to exceed its threshold.
void JoinGross(const Problem& problem, const ScoreThreshold& threshold, std::size_t before,
               std::vector<Hypothesis>& out) {
  std::vector<Hypothesis> gross(std::make_move_iterator(out.begin() + static_cast<std::ptrdiff_t>(before)),
                                std::make_move_iterator(out.end()));
  out.resize(before);
  for (Hypothesis& r : gross) {
    r.gross = true;
    const auto same = std::find_if(out.begin(), out.end(), [&](const Hypothesis& o) {
      return FamilyOf(o.effect()) == FamilyOf(r.effect());
    });
    if (same == out.end()) {
      if (r.score > Threshold(problem, threshold)) out.push_back(std::move(r));
      continue;
    }
    if (r.score > same->score) *same = std::move(r);
    same->gross = true;
  }
}

/// The worst of too many go, for the memory; sorted before.
void KeepBest(const Problem& problem, std::vector<Hypothesis>& hypotheses) {
  std::size_t kept = 0;
  std::erase_if(hypotheses, [&](const Hypothesis& r) {
    return !InBase(problem, r.effect().kind) && !Outside(r.effect().kind) && kept++ >= MostLookedAt();
  });
}

}  // namespace

bool MorePromised(const Problem& problem, const std::vector<Scored>& scored, const ScoreThreshold& threshold,
                  const std::vector<std::string>& tried) {
  return std::any_of(scored.begin(), scored.end(), [&](const Scored& s) {
    return !Outside(s.effect->kind) && !Among(tried, s) && Promising(problem, s, threshold);
  });
}

std::vector<Hypothesis> FitHypotheses(const Problem& problem, const Fit& current,
                                      const std::vector<Scored>& scored, const ScoreThreshold& threshold,
                                      std::vector<std::string>& tried) {
  std::vector<Hypothesis> out;
  double best = -std::numeric_limits<double>::infinity();
  const auto fit_all = [&](std::vector<InitialGuess> guesses) {
    for (Fit& fit : FitPoints(problem, std::move(guesses))) {
      out.push_back({std::move(fit)});
      Judge(problem, current, out.back());
      best = std::max(best, out.back().score);
    }
  };
  const bool first = tried.empty();
  for (int turn = 0; turn < kHypotheses.most_turns; ++turn) {
    double most = 0.0;
    const std::size_t from = out.size();
    fit_all(NextGuesses(problem, current, scored, threshold, tried, most));
    fit_all(OtherPlaces(problem, current, scored, std::span(out).subspan(from)));
    fit_all(OtherInstants(problem, current, std::span(out).subspan(from)));
    if (first && turn == 0) {
      const std::size_t before = out.size();
      fit_all(FromLeastSquares(problem, current, scored));
      JoinGross(problem, threshold, before, out);
    }
    if (first && turn == 0 && !out.empty()) fit_all(LongDelays(problem, current, scored, threshold, out));
    for (Fit& fit : FitPoints(problem, Mirrored(problem, current, scored, std::span(out).subspan(from)))) {
      Hypothesis mirrored{std::move(fit)};
      Judge(problem, current, mirrored);
      // A soft screw is not taken for one above by chance.
      if (mirrored.no_fault && mirrored.score <= best + AlikeScore()) continue;
      out.push_back(std::move(mirrored));
      best = std::max(best, out.back().score);
    }
    // Where the best came to nothing, those far behind it have their turn.
    if (best > kScreening.little_share * most || !MorePromised(problem, scored, threshold, tried)) break;
  }
  FitFromAbsent(problem, current, scored, out);
  Sort(out);
  KeepBest(problem, out);
  FitAllFromStated(problem, current, scored, out);
  Sort(out);
  GiveUpFarBehind(problem, kHypotheses.given_up_share, out);
  return out;
}

bool MayHold(const Problem& problem, const std::vector<Hypothesis>& hypotheses,
             const ScoreThreshold& threshold) {
  return std::any_of(hypotheses.begin(), hypotheses.end(), [&](const Hypothesis& r) {
    if (r.given_up) return false;
    const ScoreScale score_scale = threshold.accepted > 0 ? ScoreScaleOf(problem, r.fit) : ScoreScale{};
    return r.score + r.fit.promised >
           kHypotheses.half_share * Threshold(problem, threshold, r.effect(), score_scale);
  });
}

void GiveAnotherTurn(const Problem& problem, const std::vector<Hypothesis>& hypotheses,
                     const ScoreThreshold& threshold, std::vector<std::string>& tried) {
  // With nothing tried, what lies outside the catalogue would come first again, and be refused, for ever.
  for (const Hypothesis& r : hypotheses)
    if (r.refused && Outside(r.effect().kind)) tried.push_back(FamilyOf(r.effect()));
  const double least = Threshold(problem, threshold);
  for (std::size_t i = 1; i < hypotheses.size(); ++i)
    if (!hypotheses[i].refused && hypotheses[i].score > least)
      std::erase(tried, FamilyOf(hypotheses[i].effect()));
}

namespace {

/// The base may lie in another basin since: from there anew, where the score test promises far more than a
/// hypothesis has, and enough to matter.
void FitAnew(const Problem& problem, const Fit& current, std::vector<Hypothesis>& hypotheses) {
  const double matters = kHypotheses.may_matter_share * hypotheses[0].score;
  std::vector<std::size_t> again;
  std::vector<InitialGuess> guesses;
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    Hypothesis& r = hypotheses[i];
    const bool by_priors = InBase(problem, r.effect().kind);
    if (!by_priors && (!r.effect().signals || FrictionModelMismatch(problem, current))) continue;
    const Scored s = ScoreEffects(problem, current, {r.fit.point.effects.back()})[0];
    const double promised = s.drop - Penalty(*s.effect);
    if (r.score > (by_priors ? promised - kHypotheses.fitted_anew_score
                             : kHypotheses.half_share * promised - kHypotheses.new_noise_score))
      continue;
    if (!by_priors && promised < matters) continue;
    again.push_back(i);
    guesses.push_back(Near(problem, current, s));
  }
  if (again.empty()) return;
  std::vector<Fit> fits = FitPoints(problem, std::move(guesses));
  std::vector<std::size_t> on;
  guesses.clear();
  for (std::size_t i = 0; i < again.size(); ++i) {
    Hypothesis& r = hypotheses[again[i]];
    Hypothesis anew{std::move(fits[i])};
    Judge(problem, current, anew);
    // Where three steps have not led below the base, more of them do not win.
    const double least = InBase(problem, r.effect().kind) ? r.score : std::max(r.score, matters);
    if (anew.score < 0.0 || anew.score + anew.fit.promised < least) continue;
    on.push_back(again[i]);
    fits[on.size() - 1] = std::move(anew.fit);
  }
  for (std::size_t i = 0; i < on.size(); ++i)
    guesses.push_back({fits[i].point, QuickToTheEnd(), nullptr, &fits[i]});
  fits = FitPoints(problem, std::move(guesses));
  for (std::size_t i = 0; i < on.size(); ++i) {
    Hypothesis anew{std::move(fits[i])};
    Judge(problem, current, anew);
    TakeBetter(std::move(anew), hypotheses[on[i]]);
  }
}

FitEffort EffortAgain(const Fit& current, bool best) {
  const double enough = kScreening.negligible_share;
  return best ? WorthFrom(current, FitEffort{}, kHypotheses.given_up_share * enough)
              : WorthFrom(current, kEfforts.quick, enough);
}

}  // namespace

bool FitAgain(const Problem& problem, Fit& current, std::vector<Hypothesis>& hypotheses) {
  Rewhiten(problem, current);
  for (Hypothesis& r : hypotheses) {
    if (r.given_up) continue;
    RewhitenResidual(problem, r.fit);
    Judge(problem, current, r);
  }
  Sort(hypotheses);
  // What will not be tested needs no sensitivities.
  GiveUpFarBehind(problem, kHypotheses.may_matter_share, hypotheses);
  for (Hypothesis& r : hypotheses)
    if (!r.given_up) RewhitenSensitivities(problem, r.fit);
  // A basin may end in two places: the base goes on from where the best hypothesis's lies, too.
  const double best = hypotheses[0].score;
  FitEffort base;  // as well known as the scores need it
  base.close_enough = std::max(base.close_enough, kScreening.negligible_share * best);
  const Point there = WithoutLast(problem, hypotheses[0].fit.point);
  std::vector<InitialGuess> guesses = {{current.point, base, nullptr, &current},
                                       {there, WithTheirSensitivities(), &hypotheses[0].fit}};
  std::vector<std::size_t> again;
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    const Hypothesis& r = hypotheses[i];
    if (r.given_up) continue;
    if (i > 0 && r.score < kHypotheses.may_matter_share * best - kHypotheses.new_noise_score) continue;
    again.push_back(i);
    guesses.push_back({r.fit.point, EffortAgain(current, i == 0), nullptr, &hypotheses[i].fit});
  }
  const double before = hypotheses[0].fit.cost;
  const Effect* const first_before = &hypotheses[0].effect();
  std::vector<Fit> fits = FitPoints(problem, std::move(guesses));
  // Most of what the best hypothesis was to explain.
  const double most = kHypotheses.half_share * (fits[0].cost - before);
  if (MayLieLower(fits[1], fits[0], base.close_enough, most)) fits[1] = FitPoint(problem, there, base);
  const double below = fits[0].cost - fits[1].cost;
  const bool lower = below > base.close_enough;
  current = std::move(fits[lower ? 1 : 0]);
  for (std::size_t i = 0; i < again.size(); ++i) hypotheses[again[i]].fit = std::move(fits[i + 2]);
  for (Hypothesis& r : hypotheses)
    if (!r.given_up) Judge(problem, current, r);
  const Effect* const first = &hypotheses[0].effect();
  if (!hypotheses[0].no_fault) FitAnew(problem, current, hypotheses);
  Sort(hypotheses);
  OneOfEach(hypotheses);
  if (&hypotheses[0].effect() != first)
    hypotheses[0].fit = FitOn(problem, std::move(hypotheses[0].fit), QuickToTheEnd());
  if (lower && below > most) return true;
  return &hypotheses[0].effect() != first_before && BaseLiesThere(problem, hypotheses[0], base, current);
}

}  // namespace contour::diagnosis
