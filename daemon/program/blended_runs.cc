#include "daemon/program/blended_runs.h"

#include <algorithm>

#include "daemon/program/bisection.h"

namespace contour {
namespace {

constexpr double kJerkRise_s = 4e-3;

BlendLeg LegOf(const RunRequest& run, const PieceRequest& next_to_corner) {
  return {next_to_corner.curve.direction, run.speed_m_s, run.ramp,
          std::min(0.5 * run.length_m, next_to_corner.curve.length_m), 0.5 * run.length_m};
}

std::optional<CornerBlend> BlendBetween(const RunRequest& before, const RunRequest& after,
                                        const std::vector<PieceRequest>& requests,
                                        const PerAxis<PlanLimits>& limits) {
  const PieceRequest& last = requests[before.end - 1];
  const PieceRequest& first = requests[after.first];
  const bool asks = last.corner == GcodeMove::Corner::kBlended && last.dwell_s == 0.0;
  if (!asks || last.curve.kind != CurvePiece::Kind::kLine || first.curve.kind != CurvePiece::Kind::kLine)
    return std::nullopt;
  return CornerBlend::Fastest(LegOf(before, last), LegOf(after, first), first.curve.start_m,
                              BlendDeviation_m(last.tolerance_m, limits), limits);
}

BlendedJunction AsPlanned(const CornerBlend& blend) { return {blend, blend.leg(), blend.cut_m()}; }

/// The junction passed more slowly; 0 is a stop.
BlendedJunction Slowed(const BlendedJunction& junction, double factor) {
  if (junction.blend) return AsPlanned(junction.blend->Scaled(factor));
  return {std::nullopt, {factor * junction.state.speed_m_s, 0.0}, 0.0};
}

bool Fits(const RunRequest& run, const BlendedJunction& in, const BlendedJunction& out) {
  return JerkProfile::Fits(run.length_m - in.cut_m - out.cut_m, in.state, out.state, run.ramp);
}

/// Slows `faster` down until the run can pass from one to the other. A junction takes up at most half of the
/// run, so that it always fits when both are equally fast.
void Fit(const RunRequest& run, const BlendedJunction& slower, BlendedJunction& faster) {
  const auto excess = [&](const BlendedJunction& j) {
    return LowestPeak_m_s(j.state, run.ramp) - LowestPeak_m_s(slower.state, run.ramp);
  };
  if (run.length_m == 0.0 || excess(faster) <= 0.0 || Fits(run, slower, faster)) return;
  const auto fits = [&](double factor) {
    const BlendedJunction slowed = Slowed(faster, factor);
    return excess(slowed) <= 0.0 || Fits(run, slower, slowed);
  };
  faster = Slowed(faster, LargestThat(fits, 0.0, 1.0));
}

}  // namespace

double BlendDeviation_m(double tolerance_m, const PerAxis<PlanLimits>& limits) {
  double following_m = 0.0;
  for (const PlanLimits& l : limits) following_m = std::max(following_m, l.path_following_m);
  return std::max(tolerance_m - following_m, 0.5 * tolerance_m);
}

double FollowedShare(double tolerance_m, const PerAxis<PlanLimits>& limits) {
  const double left_m = tolerance_m - BlendDeviation_m(tolerance_m, limits);
  double share = 1.0;
  for (const PlanLimits& l : limits) {
    const double off_m = l.inertia_doubt_s2 * l.acceleration_m_s2;
    const double may_be_m = std::max(left_m, l.friction_doubt_m);
    if (off_m > may_be_m && may_be_m > 0.0) share = std::min(share, may_be_m / off_m);
  }
  return share;
}

PerAxis<PlanLimits> WithJerk(PerAxis<PlanLimits> limits) {
  for (PlanLimits& l : limits)
    if (!(l.jerk_m_s3 > 0.0)) l.jerk_m_s3 = l.acceleration_m_s2 / kJerkRise_s;
  return limits;
}

std::vector<BlendedJunction> BlendedJunctions(const std::vector<RunRequest>& runs,
                                              const std::vector<PieceRequest>& requests,
                                              const PerAxis<PlanLimits>& limits) {
  const std::size_t n = runs.size();
  std::vector<BlendedJunction> junctions(n + 1);
  for (std::size_t i = 1; i < n; ++i) {
    junctions[i].state.speed_m_s = CornerSpeed_m_s(requests[runs[i].first - 1], requests[runs[i].first]);
    if (junctions[i].state.speed_m_s > 0.0) continue;
    if (const auto blend = BlendBetween(runs[i - 1], runs[i], requests, limits))
      junctions[i] = AsPlanned(*blend);
  }
  for (std::size_t i = 0; i < n; ++i) Fit(runs[i], junctions[i], junctions[i + 1]);
  for (std::size_t i = n; i-- > 0;) Fit(runs[i], junctions[i + 1], junctions[i]);
  return junctions;
}

}  // namespace contour
