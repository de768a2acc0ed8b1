#include "daemon/program/piecewise_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "daemon/program/piece_limits.h"

namespace contour {
namespace {

constexpr double kScoredAfter_s = 1.0;
// Below this angle the direction counts as unchanged; programs written with a few decimals meet their
// tangents no better.
constexpr double kTangentAngle_rad = 0.02;
constexpr std::size_t kGroupSize = 16;

double CornerSpeed(const PieceRequest& before, const PieceRequest& after) {
  if (before.dwell_s > 0.0 || before.curve.length_m == 0.0 || after.curve.length_m == 0.0) return 0.0;
  const double speed = std::min(before.speed_m_s, after.speed_m_s);
  switch (before.corner) {
    case GcodeMove::Corner::kContinuous:
      return speed;
    case GcodeMove::Corner::kExactStop:
      return 0.0;
    case GcodeMove::Corner::kExactPath:
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

/// Pieces first..end of the requests as one, with what the strictest of them allows.
struct RunRequest {
  std::size_t first = 0;
  std::size_t end = 0;
  double length_m = 0.0;
  double speed_m_s = 0.0;
  RampLimits ramp;
};

RampLimits Strictest(const RampLimits& a, const RampLimits& b) {
  // No limit of jerk is written as 0.
  const bool both = a.jerk_m_s3 > 0.0 && b.jerk_m_s3 > 0.0;
  return {std::min(a.acceleration_m_s2, b.acceleration_m_s2),
          both ? std::min(a.jerk_m_s3, b.jerk_m_s3) : std::max(a.jerk_m_s3, b.jerk_m_s3),
          std::max(a.shortest_ramp_s, b.shortest_ramp_s)};
}

std::vector<RunRequest> Runs(const std::vector<PieceRequest>& requests,
                             const std::vector<RampLimits>& ramps) {
  std::vector<RunRequest> runs;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const PieceRequest& r = requests[i];
    const bool joins = i > 0 && r.speed_m_s == requests[i - 1].speed_m_s && r.speed_m_s > 0.0 &&
                       CornerSpeed(requests[i - 1], r) == r.speed_m_s;
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

/// Speeds between the runs (element i lies before run i), lowered until every run is long enough for its
/// change of speed.
std::vector<double> Junctions(const std::vector<RunRequest>& runs,
                              const std::vector<PieceRequest>& requests) {
  const std::size_t n = runs.size();
  std::vector<double> speed(n + 1, 0.0);
  for (std::size_t i = 1; i < n; ++i)
    speed[i] = CornerSpeed(requests[runs[i].first - 1], requests[runs[i].first]);
  for (std::size_t i = 0; i < n; ++i) {
    speed[i + 1] =
        std::min(speed[i + 1], ReachableSpeed_m_s(speed[i], runs[i].length_m, speed[i + 1], runs[i].ramp));
  }
  for (std::size_t i = n; i-- > 0;) {
    speed[i] = std::min(speed[i], ReachableSpeed_m_s(speed[i + 1], runs[i].length_m, speed[i], runs[i].ramp));
  }
  return speed;
}

double DistanceToBox_m(const Extent& box, const PerAxis<double>& point) {
  double squared = 0.0;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const double outside = std::max({box.min_m[i] - point[i], 0.0, point[i] - box.max_m[i]});
    squared += outside * outside;
  }
  return std::sqrt(squared);
}

void Enlarge(Extent& box, const Extent& by) {
  for (std::size_t i = 0; i < box.min_m.size(); ++i) {
    box.min_m[i] = std::min(box.min_m[i], by.min_m[i]);
    box.max_m[i] = std::max(box.max_m[i], by.max_m[i]);
  }
}

}  // namespace

PiecewisePlan::PiecewisePlan(std::vector<PieceRequest> requests, const PathTraits& traits,
                             const PerAxis<PlanLimits>& limits)
    : traits_(traits), axis_count_(limits.size()) {
  std::vector<RampLimits> ramps;
  double way_m = 0.0;
  for (PieceRequest& r : requests) {
    if (r.speed_m_s == 0.0 && r.curve.length_m > 0.0) r.speed_m_s = LargestSpeed_m_s(r.curve, limits);
    CheckPiece(r, limits);
    ramps.push_back(RampLimitsOf(r, limits));
    pieces_.push_back({r.curve, way_m});
    way_m += r.curve.length_m;
  }
  const std::vector<RunRequest> runs = Runs(requests, ramps);
  const std::vector<double> speed = Junctions(runs, requests);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunRequest& r = runs[i];
    Run run{{}, duration_s_, pieces_[r.first].before_m, r.length_m, r.first, r.end};
    if (r.length_m > 0.0) run.profile = SpeedProfile(r.length_m, speed[i], r.speed_m_s, speed[i + 1], r.ramp);
    duration_s_ += run.profile.duration_s() + requests[r.end - 1].dwell_s;
    runs_.push_back(run);
  }
  if (traits_.speed_in_one_turn) CheckSpeedWithinTurn(requests.front());
  MakeGroups();
}

void PiecewisePlan::CheckSpeedWithinTurn(const PieceRequest& first) const {
  const Run& run = runs_.front();  // shapes with turns that do not stop in corners are one run
  if (run.profile.cruise_m_s() >= first.speed_m_s * (1.0 - 1e-9) &&
      run.profile.run_up_length_m() <= traits_.turn_length_m &&
      run.profile.run_down_length_m() <= traits_.turn_length_m) {
    return;
  }
  char text[160];
  std::snprintf(text, sizeof text,
                ": %.6g mm/s is not reached within one turn of %.6g mm by the acceleration and jerk limits",
                first.speed_m_s * 1e3, traits_.turn_length_m * 1e3);
  throw ProgramError(first.origin + text);
}

void PiecewisePlan::MakeGroups() {
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Extent box = ExtentOf(pieces_[i].curve);
    if (i % kGroupSize == 0) groups_.push_back({i, i, box});
    groups_.back().end = i + 1;
    Enlarge(groups_.back().box, box);
  }
}

const PiecewisePlan::Run& PiecewisePlan::RunAt(double time_s) const {
  const auto after = std::upper_bound(runs_.begin(), runs_.end(), time_s,
                                      [](double t, const Run& r) { return t < r.begin_s; });
  return after == runs_.begin() ? *after : *(after - 1);
}

const PiecewisePlan::Piece& PiecewisePlan::PieceAt(const Run& run, double way_m) const {
  const auto first = pieces_.begin() + static_cast<std::ptrdiff_t>(run.first);
  const auto end = pieces_.begin() + static_cast<std::ptrdiff_t>(run.end);
  const auto after =
      std::upper_bound(first, end, way_m, [](double way, const Piece& p) { return way < p.before_m; });
  return after == first ? *after : *(after - 1);
}

void PiecewisePlan::At(double time_s, PerAxis<ReferencePoint>& axes) const {
  const Run& run = RunAt(time_s);
  const AlongCurve along = run.profile.At(time_s - run.begin_s);
  const double way_m = run.before_m + along.s_m;
  const Piece& piece = PieceAt(run, way_m);
  const CurvePoint p = PointAt(piece.curve, std::clamp(way_m - piece.before_m, 0.0, piece.curve.length_m));
  axes.resize(axis_count_);
  for (std::size_t i = 0; i < axis_count_; ++i) {
    axes[i] = {};
    axes[i].position_m = p.position_m[i];
    axes[i].velocity_m_s = p.tangent[i] * along.speed_m_s;
    axes[i].acceleration_m_s2 =
        p.tangent[i] * along.acceleration_m_s2 + p.curvature_1_m[i] * along.speed_m_s * along.speed_m_s;
  }
}

double PiecewisePlan::Distance_m(const PerAxis<double>& point_m) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Group& group : groups_) {
    if (DistanceToBox_m(group.box, point_m) >= nearest) continue;
    for (std::size_t i = group.first; i < group.end; ++i) {
      nearest = std::min(nearest, contour::Distance_m(pieces_[i].curve, point_m));
    }
  }
  return nearest;
}

double PiecewisePlan::Turns(double time_s) const {
  if (traits_.turn_length_m == 0.0) return 0.0;
  const Run& run = RunAt(time_s);
  return (run.before_m + run.profile.At(time_s - run.begin_s).s_m) / traits_.turn_length_m;
}

bool PiecewisePlan::Scored(double time_s) const {
  if (time_s > duration_s_) return false;
  if (!traits_.circle) return time_s >= kScoredAfter_s;
  return traits_.circle->turns > 1 && Turns(time_s) >= 1.0;
}

bool PiecewisePlan::Moves(std::size_t axis) const {
  return std::any_of(groups_.begin(), groups_.end(),
                     [&](const Group& g) { return g.box.max_m[axis] > g.box.min_m[axis]; });
}

bool PiecewisePlan::is_hold() const {
  return std::all_of(pieces_.begin(), pieces_.end(),
                     [](const Piece& p) { return p.curve.kind == CurvePiece::Kind::kPoint; });
}

}  // namespace contour
