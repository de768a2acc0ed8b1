#include "daemon/program/stretch_program.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "daemon/program/blended_runs.h"
#include "daemon/program/piece_limits.h"

namespace contour {
namespace {

// Exact path: a stop where the direction changes by more; programs written with a few decimals meet their
// tangents no better.
constexpr double kTangentAngle_rad = 0.02;
// And where it changes by less, or the curvature jumps, this share of the tolerance is enough.
constexpr double kExactShare = 0.1;
// A path that turns back by more than 170 degrees stops there, unless it is no more than a slip of the
// tolerance's size.
constexpr double kTurnsBack = 1.992;
constexpr double kSlip = 2.0;

double Turn(const CurvePiece& before, const CurvePiece& after) {
  const CurvePoint end = PointAt(before, before.length_m), begin = PointAt(after, 0.0);
  double squared = 0.0;
  for (std::size_t i = 0; i < end.tangent.size(); ++i)
    squared += std::pow(end.tangent[i] - begin.tangent[i], 2);
  return std::sqrt(squared);
}

double Deviation_m(const PieceRequest& request, const PerAxis<PlanLimits>& limits) {
  const double share_m = BlendDeviation_m(request.tolerance_m, limits);
  return request.corner == GcodeMove::Corner::kExactPath ? kExactShare * share_m : share_m;
}

bool StopsBetween(const PieceRequest& before, const PieceRequest& after) {
  if (before.dwell_s > 0.0 || before.halts != after.halts || before.corner == GcodeMove::Corner::kExactStop)
    return true;
  const double turn = Turn(before.curve, after.curve);
  if (before.corner == GcodeMove::Corner::kExactPath) return turn > kTangentAngle_rad;
  const double shorter_m = std::min(before.curve.length_m, after.curve.length_m);
  return turn > kTurnsBack && shorter_m > kSlip * before.tolerance_m;
}

// CheckRange() lets a move go so much farther, for the rounding of its numbers.
constexpr double kRounding_m = 1e-9;

Extent TravelOf(const PerAxis<PlanLimits>& limits) {
  Extent travel;
  for (const PlanLimits& l : limits) {
    travel.min_m.push_back(l.position_min_m - kRounding_m);
    travel.max_m.push_back(l.position_max_m + kRounding_m);
  }
  return travel;
}

}  // namespace

StretchProgram::StretchProgram(const std::vector<PieceRequest>& requests, const PerAxis<PlanLimits>& limits)
    : limits_(WithJerk(limits)), start_m_(requests.front().curve.start_m) {
  const PieceRequest* last = nullptr;
  moves_.reserve(requests.size());
  for (const PieceRequest& r : requests) {
    CheckRange(r, limits);
    if (r.curve.length_m == 0.0) {
      if (r.curve.kind != CurvePiece::Kind::kPoint) continue;
      // A dwell, of whatever time, is a stop.
      if (parts_.empty() || parts_.back().halts != r.halts)
        parts_.push_back({moves_.size(), moves_.size(), 0.0, r.halts});
      parts_.back().dwell_s += r.dwell_s;
      last = nullptr;
      continue;
    }
    if (last == nullptr || StopsBetween(*last, r))
      parts_.push_back({moves_.size(), moves_.size(), 0.0, r.halts});
    moves_.push_back({r.curve, r.speed_m_s, Deviation_m(r, limits), r.line});
    parts_.back().end = moves_.size();
    parts_.back().dwell_s = r.dwell_s;
    last = &r;
  }
  if (parts_.empty()) parts_.push_back({});
  CountNominal();
}

void StretchProgram::CountNominal() {
  nominal_.reserve(moves_.size() + 1);
  Nominal now;
  for (const Part& part : parts_) {
    for (std::size_t i = part.first; i < part.end; ++i) {
      nominal_.push_back(now);
      const ProgrammedMove& m = moves_[i];
      const double largest_m_s = LargestSpeed_m_s(m.curve, limits_);
      const double speed_m_s = m.feed_m_s > 0.0 ? std::min(m.feed_m_s, largest_m_s) : largest_m_s;
      now.before_s += m.curve.length_m / speed_m_s;
      now.before_m += m.curve.length_m;
    }
    now.before_s += part.dwell_s;
  }
  nominal_.push_back(now);
}

double StretchProgram::Nominal_s(const Part& part, double way_m) const {
  const double at_m = nominal_[part.first].before_m + way_m;
  const auto first = nominal_.begin() + static_cast<std::ptrdiff_t>(part.first);
  const auto end = nominal_.begin() + static_cast<std::ptrdiff_t>(part.end);
  const auto after =
      std::upper_bound(first, end, at_m, [](double m, const Nominal& n) { return m < n.before_m; });
  if (after == first) return first->before_s;
  const Nominal& from = *(after - 1);
  const Nominal& to = *after;
  const double length_m = to.before_m - from.before_m;
  if (!(length_m > 0.0)) return from.before_s;
  return from.before_s + (to.before_s - from.before_s) * std::min(1.0, (at_m - from.before_m) / length_m);
}

std::shared_ptr<const Stretch> StretchProgram::MakeStretch(const Part& part) const {
  const auto at = [&](std::size_t i) { return moves_.begin() + static_cast<std::ptrdiff_t>(i); };
  return std::make_shared<const Stretch>(
      ProgrammedPath(std::vector<ProgrammedMove>(at(part.first), at(part.end)), TravelOf(limits_)), limits_);
}

}  // namespace contour
