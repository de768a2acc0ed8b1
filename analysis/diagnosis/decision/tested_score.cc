#include "analysis/diagnosis/decision/tested_score.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/screening/gross_sliding.h"
#include "analysis/diagnosis/screening/stated_deviation.h"
#include "analysis/diagnosis/tuning/decision_tuning.h"
#include "analysis/prediction_error/common_factor.h"

namespace contour::diagnosis {
namespace {

// Of a fit that is none.
constexpr double kNoScore = -1e300;

/// A bristle behind a coupling that nobody stated is in series with it: softer than it is, and less damped.
/// Where it looks so it is taken for what is stated.
Point BehindACoupling(const Problem& problem, Point point) {
  for (std::size_t i = 0; i < point.base.size() && !problem.nominal.two_inertia; ++i)
    if (problem.terms[i].name == "s0" || problem.terms[i].name == "s1")
      point.base[i] = std::max(0.0, point.base[i]);
  return point;
}

/// Where the fit has gone the cause is not what its name says.
bool Implausible(const Problem& problem, const Hypothesis& r) {
  const CauseDefinition& cause = CauseNamed(r.effect().kind);
  // What only the stated numbers tell has to make them right: one number that is wrong is no factor on all.
  if (cause.common_factor && !Plausible(problem, BehindACoupling(problem, r.fit.point))) return true;
  return cause.implausible != nullptr &&
         (*cause.implausible)(problem, r.effect(), r.fit.point.amplitudes.back());
}

/// A coupling that every screw has.
bool NoFault(const Problem& problem, const Hypothesis& r) {
  const AxisModel m = problem.Build(r.fit.point);
  return m.two_inertia &&
         m.stiffness > m.load_inertia * std::pow(2.0 * std::numbers::pi * NoFault_Hz(problem), 2);
}

/// How far all forces together are off what is stated of them, where the fit has put them: all that there is
/// to say of a factor on them, which moves nothing.
double StatedTogether(const Problem& problem, const Point& with) {
  Point point = BehindACoupling(problem, with);
  TakeOver(problem, -std::log1p(with.amplitudes.back()[0]), point);
  return FindCommonFactor(problem, point).drop;
}

}  // namespace

bool AddsCoupling(const Problem& problem, const Hypothesis& r) {
  return CauseNamed(r.effect().kind).coupling && !problem.nominal.two_inertia;
}

void Judge(const Problem& problem, const Fit& current, Hypothesis& r) {
  // A fit may end at parameters that no machine can have.
  const bool coupling = AddsCoupling(problem, r);
  const bool ended = std::isfinite(r.fit.cost);
  r.implausible = ended && Implausible(problem, r);
  const bool out = !ended || r.implausible;
  // What filters a velocity makes it late: of a log without a position that is the column's, or the drive's.
  const bool of_column = problem.log.from_velocity && CauseNamed(r.effect().kind).about_timing;
  r.no_fault = !out && (of_column || (coupling && NoFault(problem, r)));
  r.score = out ? kNoScore : DropOf(problem, current, r.fit) - Penalty(r.effect());
}

bool Promising(const Problem& problem, const Scored& s, ScoreThreshold threshold) {
  threshold.leakage *= kScreening.little_share;
  for (auto& [kind, left] : threshold.leakage_of_kind) left *= kScreening.little_share;
  // What is there makes its own score scatter from block to block, and what it leaves passed for noise when
  // the noise was learnt: neither says that it will not hold once it is in the model.
  ScoreScale score_scale = ScoreScaleOf(problem, s);
  score_scale.overdispersion = 1.0;
  return s.drop - Penalty(*s.effect) > Threshold(problem, threshold, *s.effect, score_scale);
}

double TestedScore(const Problem& problem, const Fit& current, const Hypothesis& hypothesis) {
  const SharedEffect& effect = hypothesis.fit.point.effects.back();
  double drop = hypothesis.score + Penalty(*effect);
  double most = std::numeric_limits<double>::infinity();
  // Chance does not lower a cost that far; a base that lies elsewhere without the effect does.
  if (drop < kScreening.most_overdispersion * kAcceptance.no_chance_score && effect->start.empty() &&
      !InBase(problem, effect->kind)) {
    const Scored again = ScoreEffects(problem, current, {effect})[0];
    if (again.drop < kAcceptance.no_chance_score) drop = std::min(drop, again.drop);
    // An effect that is there makes its score scatter from block to block, but not as a single event does.
    most = kScreening.most_overdispersion * again.drop / again.within_blocks;
  }
  // A number of the base is off as far as it is from what is stated; a base that lies elsewhere without it
  // is no evidence of that.
  if (effect->common_factor)
    most = StatedTogether(problem, hypothesis.fit.point);
  else if (InBase(problem, effect->kind))
    most = StatedDeviation(problem, hypothesis.fit);
  return std::min(drop / OverdispersionOfLast(problem, hypothesis.fit), most) - Penalty(*effect);
}

}  // namespace contour::diagnosis
