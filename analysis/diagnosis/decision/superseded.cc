#include "analysis/diagnosis/decision/superseded.h"

#include <Eigen/Dense>
#include <cstddef>
#include <utility>
#include <vector>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/decision/base_there.h"
#include "analysis/diagnosis/decision/held_out.h"
#include "analysis/diagnosis/screening/gross_sliding.h"
#include "analysis/diagnosis/screening/score.h"

namespace contour::diagnosis {
namespace {

/// Without the effect at a place, as far as the fit is linear: what the cost would rise by.
double LinearDrop(const Fit& fit, std::size_t place) {
  auto first = static_cast<Eigen::Index>(fit.point.base.size());
  for (std::size_t i = 0; i < place; ++i) first += static_cast<Eigen::Index>(fit.point.amplitudes[i].size());
  const std::vector<double>& amplitudes = fit.point.amplitudes[place];
  const auto n = static_cast<Eigen::Index>(amplitudes.size());
  const Eigen::Map<const Eigen::VectorXd> a(amplitudes.data(), n);
  return a.dot(fit.covariance.block(first, first, n, n).ldlt().solve(a));
}

bool Superseded(const Problem& problem, const Fit& fit, std::size_t place, const ScoreThreshold& threshold) {
  const Effect& effect = *fit.point.effects[place];
  const double asked = Threshold(problem, ByChanceAlone(threshold), effect, ScoreScale{}) + Penalty(effect);
  // A fit without it costs time: not where the linear estimate, which may be off, is far above. Of what
  // begins far from linear it says nothing: how well a limit is known is not how much it explains.
  if (effect.start.empty() && LinearDrop(fit, place) > 2.0 * asked) return false;
  const Fit without = FitPoint(problem, Without(problem, fit.point, place), QuickToTheEnd());
  return DropOf(problem, without, fit) < asked;
}

void TakeOut(const Problem& problem, std::size_t in_fit, Accepted& accepted, Diagnosis& out) {
  accepted.fit = FitPoint(problem, Without(problem, accepted.fit.point, accepted.places[in_fit]));
  TakeBack(in_fit, accepted, out);
}

/// The last one's evidence, gain and scatter, over the same model without it.
void TellLastAnew(const Problem& problem, Accepted& accepted, Diagnosis& out) {
  const Fit without = FitPoint(problem, WithoutLast(problem, accepted.fit.point));
  const Effect& effect = *accepted.fit.point.effects.back();
  accepted.scatter.back() = ScatterOfLast(problem, accepted.fit);
  Cause& cause = out.causes.back();
  cause.log_evidence_gain = 0.5 * (DropOf(problem, without, accepted.fit) - Penalty(effect));
  std::vector<BlockGain> blocks;
  HeldOutGain(problem, without, accepted.fit, CauseNamed(cause.kind).judged_at_scale, cause, blocks);
  if (out.causes.size() == 1) out.blocks = std::move(blocks);
}

}  // namespace

bool DropSuperseded(const Problem& problem, const ScoreThreshold& threshold, Accepted& accepted,
                    Diagnosis& out) {
  bool any = false;
  for (std::size_t i = accepted.places.size(); i-- > 0;) {
    if (i + 1 == accepted.places.size()) continue;  // the new one
    if (!Superseded(problem, accepted.fit, accepted.places[i], threshold)) continue;
    TakeOut(problem, i, accepted, out);
    any = true;
  }
  if (any) TellLastAnew(problem, accepted, out);
  return any;
}

}  // namespace contour::diagnosis
