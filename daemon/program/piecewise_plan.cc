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

/// Junction i lies before piece i; the last one after the last piece.
using JunctionSpeeds = std::vector<double>;

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

/// Corner speeds, lowered until every piece is long enough for its change of speed.
JunctionSpeeds Junctions(const std::vector<PieceRequest>& requests, const std::vector<RampLimits>& ramps) {
  const std::size_t n = requests.size();
  JunctionSpeeds speed(n + 1, 0.0);
  for (std::size_t i = 1; i < n; ++i) speed[i] = CornerSpeed(requests[i - 1], requests[i]);
  for (std::size_t i = 0; i < n; ++i) {
    const double reach = ReachableSpeed_m_s(speed[i], requests[i].curve.length_m, speed[i + 1], ramps[i]);
    speed[i + 1] = std::min(speed[i + 1], reach);
  }
  for (std::size_t i = n; i-- > 0;) {
    const double reach = ReachableSpeed_m_s(speed[i + 1], requests[i].curve.length_m, speed[i], ramps[i]);
    speed[i] = std::min(speed[i], reach);
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
  for (PieceRequest& r : requests) {
    if (r.speed_m_s == 0.0 && r.curve.length_m > 0.0) r.speed_m_s = LargestSpeed_m_s(r.curve, limits);
    CheckPiece(r, limits);
    ramps.push_back(RampLimitsOf(r, limits));
  }
  const JunctionSpeeds speed = Junctions(requests, ramps);
  double way_m = 0.0;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const PieceRequest& r = requests[i];
    Piece piece{r.curve, {}, duration_s_, way_m};
    if (r.curve.length_m > 0.0) {
      piece.profile = SpeedProfile(r.curve.length_m, speed[i], r.speed_m_s, speed[i + 1], ramps[i]);
    }
    duration_s_ += piece.profile.duration_s() + r.dwell_s;
    way_m += r.curve.length_m;
    pieces_.push_back(piece);
  }
  if (traits_.speed_in_one_turn) CheckSpeedWithinTurn(requests);
  MakeGroups();
}

void PiecewisePlan::CheckSpeedWithinTurn(const std::vector<PieceRequest>& requests) const {
  const double wanted = requests.front().speed_m_s;
  const auto at_speed = [&](const Piece& p) { return p.profile.cruise_m_s() >= wanted * (1.0 - 1e-9); };
  const auto first = std::find_if(pieces_.begin(), pieces_.end(), at_speed);
  const auto last = std::find_if(pieces_.rbegin(), pieces_.rend(), at_speed);
  if (first != pieces_.end()) {
    const double run_up = first->before_m + first->profile.run_up_length_m();
    const double after = last->curve.length_m - last->profile.run_down_length_m();
    const double run_down = pieces_.back().before_m + pieces_.back().curve.length_m - last->before_m - after;
    if (run_up <= traits_.turn_length_m && run_down <= traits_.turn_length_m) return;
  }
  char text[160];
  std::snprintf(text, sizeof text,
                ": %.6g mm/s is not reached within one turn of %.6g mm by the acceleration and jerk limits",
                wanted * 1e3, traits_.turn_length_m * 1e3);
  throw ProgramError(requests.front().origin + text);
}

void PiecewisePlan::MakeGroups() {
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Extent box = ExtentOf(pieces_[i].curve);
    if (i % kGroupSize == 0) groups_.push_back({i, i, box});
    groups_.back().end = i + 1;
    Enlarge(groups_.back().box, box);
  }
}

const PiecewisePlan::Piece& PiecewisePlan::PieceAt(double time_s) const {
  const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), time_s,
                                      [](double t, const Piece& p) { return t < p.begin_s; });
  return after == pieces_.begin() ? *after : *(after - 1);
}

void PiecewisePlan::At(double time_s, PerAxis<ReferencePoint>& axes) const {
  const Piece& piece = PieceAt(time_s);
  const AlongCurve along = piece.profile.At(time_s - piece.begin_s);
  const CurvePoint p = PointAt(piece.curve, along.s_m);
  axes.resize(axis_count_);
  for (std::size_t i = 0; i < axis_count_; ++i) {
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
  const Piece& piece = PieceAt(time_s);
  return (piece.before_m + piece.profile.At(time_s - piece.begin_s).s_m) / traits_.turn_length_m;
}

bool PiecewisePlan::Scored(double time_s) const {
  if (time_s > duration_s_) return false;
  if (!traits_.circle) return time_s >= kScoredAfter_s;
  return traits_.circle->turns > 1 && Turns(time_s) >= 1.0;
}

bool PiecewisePlan::is_hold() const {
  return std::all_of(pieces_.begin(), pieces_.end(),
                     [](const Piece& p) { return p.curve.kind == CurvePiece::Kind::kPoint; });
}

}  // namespace contour
