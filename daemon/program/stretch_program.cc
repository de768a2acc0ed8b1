#include "daemon/program/stretch_program.h"

#include <algorithm>
#include <cmath>

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
// Moves from one mark of time to the next.
constexpr std::size_t kMark = 64;

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

}  // namespace

StretchProgram::StretchProgram(const PerAxis<double>& start_m, const PerAxis<PlanLimits>& limits)
    : limits_(WithJerk(limits)), stated_(limits), moves_(start_m), box_{start_m, start_m} {}

bool StretchProgram::StopsBefore(const PieceRequest& request) const {
  if (last_.curve.length_m == 0.0 || last_.dwell_s > 0.0 || last_.halts != request.halts ||
      last_.corner == GcodeMove::Corner::kExactStop)
    return true;
  const double turn = Turn(last_.curve, request.curve);
  if (last_.corner == GcodeMove::Corner::kExactPath) return turn > kTangentAngle_rad;
  const double shorter_m = std::min(last_.curve.length_m, request.curve.length_m);
  return turn > kTurnsBack && shorter_m > kSlip * last_.tolerance_m;
}

// A dwell, of whatever time, is a stop.
void StretchProgram::AddDwell(const PieceRequest& r) {
  if (parts_.empty() || parts_.back().halts != r.halts)
    parts_.push_back({moves_.size(), moves_.size(), 0.0, r.halts, 0.0, nominal_s(), 0.0});
  parts_.back().dwell_s += r.dwell_s;
  last_ = {};
}

double StretchProgram::Time_s(const ProgrammedMove& m) const {
  const double largest_m_s = LargestSpeed_m_s(m.curve, limits_);
  return m.curve.length_m / (m.feed_m_s > 0.0 ? std::min(m.feed_m_s, largest_m_s) : largest_m_s);
}

void StretchProgram::Add(const PieceRequest& r, const PerAxis<double>& end_m) {
  const Extent extent = CheckRange(r, stated_);
  if (r.curve.length_m == 0.0) {
    if (r.curve.kind == CurvePiece::Kind::kPoint) AddDwell(r);
    return;
  }
  Enlarge(box_, extent);
  if (StopsBefore(r)) parts_.push_back({moves_.size(), moves_.size(), 0.0, r.halts, 0.0, nominal_s(), 0.0});
  moves_.Add({r.curve, r.speed_m_s, Deviation_m(r, stated_), r.line}, end_m);
  Part& part = parts_.back();
  const std::size_t i = part.end++;
  if (i % kMark == 0) marks_.push_back({part.moves_s, part.length_m});
  const ProgrammedMove move = moves_.Move(i);
  part.moves_s += Time_s(move);
  part.length_m += move.curve.length_m;
  part.dwell_s = r.dwell_s;
  part.share = std::min(part.share, FollowedShare(r.tolerance_m, stated_));
  last_ = r;
}

PerAxis<PlanLimits> StretchProgram::LimitsOf(const Part& part) const {
  PerAxis<PlanLimits> limits = limits_;
  for (PlanLimits& l : limits) {
    l.acceleration_m_s2 *= part.share;
    l.jerk_m_s3 *= part.share;
  }
  return limits;
}

double StretchProgram::nominal_s() const {
  if (parts_.empty()) return 0.0;
  return parts_.back().begin_s + parts_.back().moves_s + parts_.back().dwell_s;
}

double StretchProgram::Nominal_s(const Part& part, double way_m) const {
  if (way_m >= part.length_m) return part.begin_s + part.moves_s;
  const std::size_t first = (part.first + kMark - 1) / kMark, end = (part.end + kMark - 1) / kMark;
  // The first mark behind that way.
  std::size_t mark = first;
  for (std::size_t not_yet = std::max(first, end); mark < not_yet;) {
    const std::size_t middle = mark + (not_yet - mark) / 2;
    if (way_m < marks_[middle].since_m)
      not_yet = middle;
    else
      mark = middle + 1;
  }
  Mark now = mark > first ? marks_[mark - 1] : Mark{};
  for (std::size_t i = mark > first ? (mark - 1) * kMark : part.first; i < part.end; ++i) {
    const ProgrammedMove move = moves_.Move(i);
    const double time_s = Time_s(move), left_m = way_m - now.since_m;
    if (left_m < move.curve.length_m)
      return part.begin_s + now.since_s + time_s * std::max(0.0, left_m) / move.curve.length_m;
    now.since_m += move.curve.length_m;
    now.since_s += time_s;
  }
  return part.begin_s + part.moves_s;
}

std::size_t StretchProgram::bytes_in_memory() const {
  return moves_.bytes_in_memory() + parts_.bytes_in_memory() + marks_.bytes_in_memory();
}

}  // namespace contour
