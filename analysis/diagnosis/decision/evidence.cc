#include "analysis/diagnosis/decision/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "analysis/diagnosis/decision/choose.h"
#include "analysis/diagnosis/decision/held_out.h"
#include "analysis/diagnosis/decision/tested_score.h"
#include "analysis/diagnosis/tuning/model_error.h"

namespace contour::diagnosis {
namespace {

// Below: the hypothesis was refused, there is no score.
constexpr double kRefused = -1e6;

}  // namespace

void TellEvidence(const Problem& problem, const Accepted& accepted, const std::vector<Scored>& scored,
                  const std::vector<Hypothesis>& hypotheses, const ScoreThreshold& threshold,
                  const DiagnoseOptions& options) {
  if (!options.evidence) return;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::string> told;
  for (const Scored& s : scored) {
    const std::string& kind = s.effect->kind;
    if (std::find(told.begin(), told.end(), kind) != told.end()) continue;
    told.push_back(kind);
    Evidence e;
    e.accepted = threshold.accepted;
    e.explained = accepted.explained;
    e.in_base = InBase(problem, kind);
    e.kind = kind;
    e.screened = s.drop;
    e.penalty = Penalty(*s.effect);
    e.overdispersion = s.overdispersion;
    e.refitted = e.tested = e.unseen = kNone;
    e.flips = threshold.calibrated;
    e.asked = Threshold(problem, threshold, *s.effect, ScoreScaleOf(problem, s));
    for (const Hypothesis& r : hypotheses) {
      if (r.effect().kind != kind || r.score < kRefused || r.given_up) continue;
      e.penalty = Penalty(r.effect());
      e.refitted = r.score + e.penalty;
      e.asked = Asked(problem, r, threshold);
      e.tested = TestedScore(problem, accepted.fit, r);
      e.unseen = Consistency(problem, accepted.fit, r.fit, LeftOut::kBlock);
    }
    options.evidence(e);
  }
}

void TellStructure(const Accepted& accepted, const std::vector<RemainingStructure>& left,
                   const DiagnoseOptions& options) {
  if (!options.evidence) return;
  for (const std::string_view structure_class : kStructureClasses) {
    const auto best = std::find_if(left.begin(), left.end(), [&](const RemainingStructure& l) {
      return l.structure_class == structure_class;
    });
    if (best == left.end()) continue;
    Evidence e;
    e.accepted = static_cast<int>(accepted.places.size());
    e.explained = accepted.explained;
    e.kind = structure_class;
    e.screened = best->drop;
    e.penalty = best->bins;
    e.refitted = e.tested = best->score;
    e.unseen = std::sqrt(best->score);
    e.flips = -2.0 * std::log(kRounds.false_alarm_rate);
    e.asked = best->asked;
    options.evidence(e);
  }
}

}  // namespace contour::diagnosis
