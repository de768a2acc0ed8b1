#include "daemon/program/piecewise_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "daemon/program/blended_runs.h"
#include "daemon/program/path_runs.h"
#include "daemon/program/piece_limits.h"

namespace contour {
namespace {

constexpr double kScoredAfter_s = 1.0;
constexpr std::size_t kGroupSize = 16;

}  // namespace

PiecewisePlan::PiecewisePlan(std::vector<PieceRequest> requests, const PathTraits& traits,
                             const PerAxis<PlanLimits>& limits)
    : traits_(traits), axis_count_(limits.size()) {
  const bool blended = std::any_of(requests.begin(), requests.end(), [](const PieceRequest& r) {
    return r.corner == GcodeMove::Corner::kBlended;
  });
  const PerAxis<PlanLimits> ramp_limits = blended ? WithJerk(limits) : limits;
  std::vector<RampLimits> ramps;
  double way_m = 0.0;
  for (PieceRequest& r : requests) {
    if (r.speed_m_s == 0.0 && r.curve.length_m > 0.0) r.speed_m_s = LargestSpeed_m_s(r.curve, limits);
    CheckPiece(r, limits);
    ramps.push_back(RampLimitsOf(r, ramp_limits));
    pieces_.push_back({r.curve, way_m, r.line});
    way_m += r.curve.length_m;
  }
  if (blended) {
    AddBlendedRuns(requests, ramps, ramp_limits);
  } else {
    AddRuns(requests, ramps);
  }
  if (traits_.speed_in_one_turn) CheckSpeedWithinTurn(requests.front());
  MakeGroups();
}

void PiecewisePlan::Add(Run run, double dwell_s) {
  run.begin_s = duration_s_;
  duration_s_ += std::visit([](const auto& m) { return m.duration_s(); }, run.motion) + dwell_s;
  runs_.push_back(std::move(run));
}

void PiecewisePlan::AddRuns(const std::vector<PieceRequest>& requests, const std::vector<RampLimits>& ramps) {
  const std::vector<RunRequest> runs = Runs(requests, ramps);
  const std::vector<double> speed = Junctions(runs, requests);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunRequest& r = runs[i];
    Run run{{}, 0.0, pieces_[r.first].before_m, r.length_m, r.first, r.end};
    if (r.length_m > 0.0) run.motion = SpeedProfile(r.length_m, speed[i], r.speed_m_s, speed[i + 1], r.ramp);
    Add(std::move(run), requests[r.end - 1].dwell_s);
  }
}

void PiecewisePlan::AddBlendedRuns(const std::vector<PieceRequest>& requests,
                                   const std::vector<RampLimits>& ramps, const PerAxis<PlanLimits>& limits) {
  const std::vector<RunRequest> runs = Runs(requests, ramps);
  const std::vector<BlendedJunction> junctions = BlendedJunctions(runs, requests, limits);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunRequest& r = runs[i];
    const BlendedJunction& in = junctions[i];
    const BlendedJunction& out = junctions[i + 1];
    const double begin_m = pieces_[r.first].before_m;
    if (in.blend) Add({*in.blend, 0.0, begin_m - in.cut_m, 2.0 * in.cut_m, r.first, r.first + 1}, 0.0);
    const double length_m = r.length_m - in.cut_m - out.cut_m;
    Run run{{}, 0.0, begin_m + in.cut_m, length_m, r.first, r.end};
    if (length_m > 0.0) run.motion = JerkProfile(length_m, in.state, r.speed_m_s, out.state, r.ramp);
    Add(std::move(run), requests[r.end - 1].dwell_s);
  }
}

void PiecewisePlan::CheckSpeedWithinTurn(const PieceRequest& first) const {
  // Shapes with turns that neither stop in corners nor blend them are one run.
  const auto& profile = std::get<SpeedProfile>(runs_.front().motion);
  if (profile.cruise_m_s() >= first.speed_m_s * (1.0 - 1e-9) &&
      profile.run_up_length_m() <= traits_.turn_length_m &&
      profile.run_down_length_m() <= traits_.turn_length_m) {
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

AlongCurve PiecewisePlan::Along(const Run& run, double since_begin_s) {
  if (const auto* profile = std::get_if<SpeedProfile>(&run.motion)) return profile->At(since_begin_s);
  if (const auto* profile = std::get_if<JerkProfile>(&run.motion)) return profile->At(since_begin_s);
  // A blend leaves the path; how far it has got is only told for counting turns.
  const double duration_s = std::get<CornerBlend>(run.motion).duration_s();
  return {run.length_m * std::clamp(since_begin_s / duration_s, 0.0, 1.0), 0.0, 0.0};
}

void PiecewisePlan::At(double time_s, PerAxis<ReferencePoint>& axes) const {
  const Run& run = RunAt(time_s);
  if (const auto* blend = std::get_if<CornerBlend>(&run.motion)) {
    blend->At(time_s - run.begin_s, axes);
    return;
  }
  const AlongCurve along = Along(run, time_s - run.begin_s);
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

std::uint32_t PiecewisePlan::Line(double time_s) const {
  const Run& run = RunAt(time_s);
  return static_cast<std::uint32_t>(PieceAt(run, run.before_m + Along(run, time_s - run.begin_s).s_m).line);
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
  return (run.before_m + Along(run, time_s - run.begin_s).s_m) / traits_.turn_length_m;
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
