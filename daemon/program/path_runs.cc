#include "daemon/program/path_runs.h"

#include <algorithm>
#include <cmath>

namespace contour {
namespace {

// Below this angle the direction counts as unchanged; programs written with a few decimals meet their
// tangents no better.
constexpr double kTangentAngle_rad = 0.02;

RampLimits Strictest(const RampLimits& a, const RampLimits& b) {
  // No limit of jerk is written as 0.
  const bool both = a.jerk_m_s3 > 0.0 && b.jerk_m_s3 > 0.0;
  return {std::min(a.acceleration_m_s2, b.acceleration_m_s2),
          both ? std::min(a.jerk_m_s3, b.jerk_m_s3) : std::max(a.jerk_m_s3, b.jerk_m_s3),
          std::max(a.shortest_ramp_s, b.shortest_ramp_s)};
}

}  // namespace

double CornerSpeed_m_s(const PieceRequest& before, const PieceRequest& after) {
  if (before.dwell_s > 0.0 || before.curve.length_m == 0.0 || after.curve.length_m == 0.0) return 0.0;
  const double speed = std::min(before.speed_m_s, after.speed_m_s);
  switch (before.corner) {
    case GcodeMove::Corner::kContinuous:
      return speed;
    case GcodeMove::Corner::kExactStop:
      return 0.0;
    case GcodeMove::Corner::kExactPath:
    case GcodeMove::Corner::kBlended:  // what is not tangent is blended, or a stop
      break;
  }
  const CurvePoint end = PointAt(before.curve, before.curve.length_m);
  const CurvePoint begin = PointAt(after.curve, 0.0);
  double squared = 0.0;
  for (std::size_t i = 0; i < end.tangent.size(); ++i) {
    squared += std::pow(end.tangent[i] - begin.tangent[i], 2);
  }
  return std::sqrt(squared) < kTangentAngle_rad ? speed : 0.0;
}

std::vector<RunRequest> Runs(const std::vector<PieceRequest>& requests,
                             const std::vector<RampLimits>& ramps) {
  std::vector<RunRequest> runs;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const PieceRequest& r = requests[i];
    const bool joins = i > 0 && r.speed_m_s == requests[i - 1].speed_m_s && r.speed_m_s > 0.0 &&
                       CornerSpeed_m_s(requests[i - 1], r) == r.speed_m_s;
    if (joins) {
      RunRequest& run = runs.back();
      run.end = i + 1;
      run.length_m += r.curve.length_m;
      run.ramp = Strictest(run.ramp, ramps[i]);
    } else {
      runs.push_back({i, i + 1, r.curve.length_m, r.speed_m_s, ramps[i]});
    }
  }
  return runs;
}

std::vector<double> Junctions(const std::vector<RunRequest>& runs,
                              const std::vector<PieceRequest>& requests) {
  const std::size_t n = runs.size();
  std::vector<double> speed(n + 1, 0.0);
  for (std::size_t i = 1; i < n; ++i)
    speed[i] = CornerSpeed_m_s(requests[runs[i].first - 1], requests[runs[i].first]);
  for (std::size_t i = 0; i < n; ++i) {
    speed[i + 1] =
        std::min(speed[i + 1], ReachableSpeed_m_s(speed[i], runs[i].length_m, speed[i + 1], runs[i].ramp));
  }
  for (std::size_t i = n; i-- > 0;) {
    speed[i] = std::min(speed[i], ReachableSpeed_m_s(speed[i + 1], runs[i].length_m, speed[i], runs[i].ramp));
  }
  return speed;
}

}  // namespace contour
