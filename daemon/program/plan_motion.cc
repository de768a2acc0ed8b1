#include <algorithm>
#include <cmath>
#include <numbers>

#include "config/number_text.h"
#include "daemon/program/combined_plans.h"
#include "daemon/program/gcode/program_halts.h"
#include "daemon/program/motion_plan.h"
#include "daemon/program/oscillation_plan.h"
#include "daemon/program/piecewise_plan.h"
#include "daemon/program/stretch_plan.h"
#include "daemon/program/torque_plan.h"
#include "daemon/program/torque_steps_plan.h"

namespace contour {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
// Circles and sines come up to speed in this time, or within a quarter turn: gentler than the axes' limits
// usually ask, so that the first turn settles the machine. The limits may make it longer.
constexpr double kGentleRamp_s = 0.2;

using Plane = std::array<std::size_t, 2>;

/// Where the machine stands, and what its axes are called and may do.
struct Place {
  const Program& program;
  const PerAxis<double>& start_m;
  const PerAxis<PlanLimits>& limits;
};

[[noreturn]] void RefuseDuration(const Program& program) {
  throw ProgramError(program.name + ": the program would take more than three years");
}

std::string AxisList(const Place& place) {
  std::string list;
  for (const PlanLimits& l : place.limits) list += (list.empty() ? "" : ", ") + l.axis;
  return list;
}

std::size_t Find(const Place& place, const std::string& axis, const std::string& where) {
  const auto found = std::find_if(place.limits.begin(), place.limits.end(),
                                  [&](const PlanLimits& l) { return l.axis == axis; });
  if (found == place.limits.end()) {
    throw ProgramError(where + ": axis " + axis + ": the machine has no such axis, but " + AxisList(place));
  }
  return static_cast<std::size_t>(found - place.limits.begin());
}

std::size_t Find(const Place& place, const std::string& axis) {
  return Find(place, axis, place.program.name);
}

Plane FindPlane(const Place& place, const PlaneAxes& axes) {
  if (!axes.empty()) return {Find(place, axes[0]), Find(place, axes[1])};
  if (place.limits.size() < 2) {
    throw ProgramError(place.program.name + ": this shape needs two axes, but the machine has only " +
                       AxisList(place));
  }
  const auto has = [&](const char* name) {
    return std::any_of(place.limits.begin(), place.limits.end(),
                       [&](const PlanLimits& l) { return l.axis == name; });
  };
  return has("x") && has("y") ? Plane{Find(place, "x"), Find(place, "y")} : Plane{0, 1};
}

double Speed_m_s(const Feed& feed, double turn_length_m) {
  return feed.feed_mm_min ? *feed.feed_mm_min * 1e-3 / 60.0 : *feed.frequency_hz * turn_length_m;
}

PerAxis<double> Moved(PerAxis<double> from, const Plane& plane, double dx_m, double dy_m) {
  from[plane[0]] += dx_m;
  from[plane[1]] += dy_m;
  return from;
}

PieceRequest RoundPiece(const Place& place, const CurvePiece& curve, double speed_m_s) {
  const double half_turn_s = std::numbers::pi * curve.radius_m / speed_m_s;
  PieceRequest request;
  request.curve = curve;
  request.speed_m_s = speed_m_s;
  request.shortest_ramp_s = std::min(kGentleRamp_s, half_turn_s);  // covers at most a quarter turn
  request.origin = place.program.name;
  return request;
}

std::shared_ptr<const MotionPlan> Plan(const CircleShape& shape, const Place& place) {
  const Plane plane = FindPlane(place, shape.axes);
  const double radius = shape.radius_mm * 1e-3;
  const bool ccw = shape.direction == Direction::kCcw;
  PathTraits traits;
  traits.turn_length_m = kTurn_rad * radius;
  traits.speed_in_one_turn = true;
  traits.circle = CommandedCircle{{plane[0], plane[1]},
                                  {place.start_m[plane[0]] - radius, place.start_m[plane[1]]},
                                  radius,
                                  ccw,
                                  shape.turns};
  const CurvePiece arc =
      ArcPiece(place.start_m, plane, {traits.circle->centre_m[0], traits.circle->centre_m[1]},
               (ccw ? kTurn_rad : -kTurn_rad) * shape.turns);
  const double speed = Speed_m_s(shape.feed, traits.turn_length_m);
  return std::make_shared<PiecewisePlan>(std::vector{RoundPiece(place, arc, speed)}, traits, place.limits);
}

/// Where the program gives none.
double PathTolerance_m(const PerAxis<PlanLimits>& limits) {
  double tolerance_m = limits[0].path_tolerance_m;
  for (const PlanLimits& l : limits) tolerance_m = std::min(tolerance_m, l.path_tolerance_m);
  return tolerance_m;
}

/// A closed polygon with the given sides, counter-clockwise; clockwise mirrors it at the X axis.
std::shared_ptr<const MotionPlan> PlanSquare(const SquareShape& shape, const Place& place,
                                             double turned_rad) {
  const Plane plane = FindPlane(place, shape.axes);
  const double side = shape.side_mm * 1e-3;
  const double mirror = shape.direction == Direction::kCcw ? 1.0 : -1.0;
  GcodeMove::Corner corner = GcodeMove::Corner::kBlended;
  if (shape.corners == Corners::kExactStop) corner = GcodeMove::Corner::kExactStop;
  if (shape.corners == Corners::kVelocityJump) corner = GcodeMove::Corner::kContinuous;
  PathTraits traits;
  traits.turn_length_m = 4.0 * side;
  traits.speed_in_one_turn = corner == GcodeMove::Corner::kContinuous;
  std::array<PerAxis<double>, 4> corners;
  corners[0] = place.start_m;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    const double angle = turned_rad + 0.5 * std::numbers::pi * static_cast<double>(k);
    corners[k + 1] = Moved(corners[k], plane, side * std::cos(angle), mirror * side * std::sin(angle));
  }
  std::vector<PieceRequest> requests;
  for (std::size_t k = 0; k < 4 * static_cast<std::size_t>(shape.turns); ++k) {
    PieceRequest request;
    request.curve = LinePiece(corners[k % 4], corners[(k + 1) % 4]);
    request.speed_m_s = Speed_m_s(shape.feed, traits.turn_length_m);
    request.corner = corner;
    request.tolerance_m =
        shape.corner_tolerance_mm ? *shape.corner_tolerance_mm * 1e-3 : PathTolerance_m(place.limits);
    request.origin = place.program.name;
    requests.push_back(request);
  }
  return std::make_shared<PiecewisePlan>(std::move(requests), traits, place.limits);
}

std::shared_ptr<const MotionPlan> Plan(const SquareShape& shape, const Place& place) {
  return PlanSquare(shape, place, 0.0);
}

std::shared_ptr<const MotionPlan> Plan(const DiamondShape& shape, const Place& place) {
  return PlanSquare(shape, place, 0.25 * std::numbers::pi);
}

std::shared_ptr<const MotionPlan> Plan(const LineShape& shape, const Place& place) {
  PerAxis<double> end = place.start_m;
  if (shape.dy_mm == 0.0 && shape.axes.empty()) {
    // A line along one axis suits a machine with one axis.
    end[place.limits.size() < 2 ? 0 : FindPlane(place, {})[0]] += shape.dx_mm * 1e-3;
  } else {
    end = Moved(end, FindPlane(place, shape.axes), shape.dx_mm * 1e-3, shape.dy_mm * 1e-3);
  }
  PieceRequest request;
  request.curve = LinePiece(place.start_m, end);
  request.speed_m_s = Speed_m_s(shape.feed, 0.0);
  request.origin = place.program.name;
  return std::make_shared<PiecewisePlan>(std::vector{request}, PathTraits{}, place.limits);
}

std::shared_ptr<const MotionPlan> Plan(const SineShape& shape, const Place& place) {
  const double amplitude = shape.amplitude_mm * 1e-3;
  PathTraits traits;
  traits.turn_length_m = kTurn_rad * amplitude;
  traits.speed_in_one_turn = true;
  const CurvePiece sine = SinePiece(place.start_m, Find(place, shape.axis), amplitude, shape.cycles);
  const double speed = Speed_m_s(shape.feed, traits.turn_length_m);
  return std::make_shared<PiecewisePlan>(std::vector{RoundPiece(place, sine, speed)}, traits, place.limits);
}

PieceRequest Dwell(const Place& place, const PerAxis<double>& at_m, double seconds) {
  PieceRequest request;
  request.curve = PointPiece(at_m);
  request.dwell_s = seconds;
  request.origin = place.program.name;
  return request;
}

std::shared_ptr<const MotionPlan> Plan(const HoldShape& shape, const Place& place) {
  return std::make_shared<PiecewisePlan>(std::vector{Dwell(place, place.start_m, shape.seconds)},
                                         PathTraits{}, place.limits);
}

std::shared_ptr<const MotionPlan> Plan(const CreepShape& shape, const Place& place) {
  PerAxis<double> far = place.start_m;
  far[Find(place, shape.axis)] += shape.stroke_mm * 1e-3;
  std::vector<PieceRequest> requests{Dwell(place, place.start_m, shape.dwell_s)};
  for (int repeat = 0; repeat < shape.repeats; ++repeat) {
    for (const double velocity_mm_s : shape.velocities_mm_s) {
      for (const bool forth : {true, false}) {
        PieceRequest request;
        request.curve = forth ? LinePiece(place.start_m, far) : LinePiece(far, place.start_m);
        request.speed_m_s = velocity_mm_s * 1e-3;
        request.dwell_s = shape.dwell_s;
        request.origin = place.program.name;
        requests.push_back(request);
      }
    }
  }
  return std::make_shared<PiecewisePlan>(std::move(requests), PathTraits{}, place.limits);
}

std::shared_ptr<const MotionPlan> Plan(const MultisineShape& shape, const Place& place) {
  return std::make_shared<OscillationPlan>(shape, Find(place, shape.axis), place.start_m, place.limits,
                                           place.program.name);
}

std::shared_ptr<const MotionPlan> Plan(const SweepShape& shape, const Place& place) {
  return std::make_shared<OscillationPlan>(shape, Find(place, shape.axis), place.start_m, place.limits,
                                           place.program.name);
}

std::shared_ptr<const MotionPlan> Plan(const ReversalsShape& shape, const Place& place) {
  const std::size_t axis = Find(place, shape.axis);
  std::vector<PieceRequest> requests;
  for (const double amplitude_mm : shape.amplitudes_mm) {
    const CurvePiece sine = SinePiece(place.start_m, axis, amplitude_mm * 1e-3, shape.cycles);
    requests.push_back(RoundPiece(place, sine, kTurn_rad * shape.frequency_hz * amplitude_mm * 1e-3));
    requests.back().dwell_s = shape.dwell_s;
  }
  return std::make_shared<PiecewisePlan>(std::move(requests), PathTraits{}, place.limits);
}

std::shared_ptr<const MotionPlan> Plan(const TorqueStepsShape& shape, const Place& place) {
  return std::make_shared<TorqueStepsPlan>(shape, Find(place, shape.axis), place.start_m, place.limits,
                                           place.program.name);
}

PerAxis<double> EndOf(const MotionPlan& plan) {
  PerAxis<ReferencePoint> end;
  plan.At(plan.duration_s(), end);
  PerAxis<double> at_m;
  for (const ReferencePoint& p : end) at_m.push_back(p.position_m);
  return at_m;
}

std::shared_ptr<const MotionPlan> Plan(const SequenceShape& shape, const Place& place) {
  SequencePlan::Plans plans;
  PerAxis<double> at_m = place.start_m;
  for (int repeat = 0; repeat < shape.repeats; ++repeat) {
    // A sequence that came back to where it began is the same once more.
    const bool same = repeat > 0 && std::equal(at_m.begin(), at_m.end(), place.start_m.begin());
    for (std::size_t i = 0; i < shape.parts.size(); ++i) {
      plans.push_back(same ? plans[i] : PlanMotion(shape.parts[i], at_m, place.limits));
      at_m = EndOf(*plans.back());
    }
  }
  return std::make_shared<SequencePlan>(std::move(plans));
}

std::shared_ptr<const MotionPlan> Plan(const TogetherShape& shape, const Place& place) {
  SequencePlan::Plans plans;
  for (const Program& part : shape.parts) plans.push_back(PlanMotion(part, place.start_m, place.limits));
  return std::make_shared<TogetherPlan>(std::move(plans), place.limits, place.program.name);
}

CurvePiece Helix(const PerAxis<double>& zero_m, const PerAxis<double>& at, const PerAxis<double>& target,
                 const Plane& plane, const GcodeMove& move) {
  return HelixPiece(at, target, plane,
                    {zero_m[plane[0]] + move.centre_m[0], zero_m[plane[1]] + move.centre_m[1]},
                    move.sweep_rad);
}

std::shared_ptr<const MotionPlan> Plan(const GcodeMoves& program, const Place& place) {
  std::vector<std::size_t> axis;
  for (std::size_t k = 0; k < program.letters.size(); ++k) {
    const std::string where = place.program.name + ":" + std::to_string(program.letter_lines[k]);
    axis.push_back(Find(place, std::string(1, static_cast<char>(program.letters[k] - 'A' + 'a')), where));
  }
  StretchProgram stretches(place.start_m, place.limits);
  double longest_s = 0.0;
  PerAxis<double> zero_m = place.start_m;
  for (std::size_t k = 0; k < axis.size(); ++k) zero_m[axis[k]] -= program.start_m[k];
  PerAxis<double> at = place.start_m;
  const std::vector<ProgramHalt> halts = HaltsOf(program);
  std::uint32_t passed = 0;
  const auto halts_before = [&](std::size_t move) {
    while (passed < halts.size() && halts[passed].before_move <= move) ++passed;
    return passed;
  };
  for (auto next = program.moves.begin(); next != program.moves.end(); ++next) {
    const GcodeMove& move = *next;
    PerAxis<double> target = at;
    for (std::size_t k = 0; k < axis.size(); ++k) target[axis[k]] = zero_m[axis[k]] + move.target_m[k];
    PieceRequest request;
    request.origin = place.program.name + ":" + std::to_string(move.line);
    request.speed_m_s = move.kind == GcodeMove::Kind::kRapid ? 0.0 : move.feed_m_s;
    request.dwell_s = move.dwell_s;
    request.line = move.line;
    request.halts = halts_before(next.index());
    request.corner = move.corner;
    request.tolerance_m =
        move.corner == GcodeMove::Corner::kBlended ? move.tolerance_m : PathTolerance_m(place.limits);
    switch (move.kind) {
      case GcodeMove::Kind::kDwell:
        request.curve = PointPiece(at);
        break;
      case GcodeMove::Kind::kRapid:
      case GcodeMove::Kind::kLine:
        request.curve = LinePiece(at, target);
        break;
      case GcodeMove::Kind::kArc:
        request.curve = Helix(zero_m, at, target, {axis[move.plane[0]], axis[move.plane[1]]}, move);
        break;
    }
    // An arc's end may miss its target by a few decimals; the next move begins where it ended.
    at = move.kind == GcodeMove::Kind::kArc ? PointAt(request.curve, request.curve.length_m).position_m
                                            : target;
    stretches.Add(request, at);
    longest_s += move.dwell_s + (request.speed_m_s > 0.0 ? request.curve.length_m / request.speed_m_s : 0.0);
  }
  if (!(longest_s <= kLongestProgram_s)) RefuseDuration(place.program);
  if (passed < halts.size()) {
    PieceRequest end = Dwell(place, at, 0.0);
    end.halts = halts_before(program.moves.size());
    stretches.Add(end, at);
  }
  if (stretches.parts().empty()) stretches.Add(Dwell(place, at, 0.0), at);
  return std::make_shared<StretchPlan>(std::move(stretches));
}

}  // namespace

std::string YearsText(double feed_percent, const std::string& what) {
  return "at " + NumberText(feed_percent) + " percent of its feed " + what +
         " would take more than three years";
}

std::shared_ptr<const MotionPlan> PlanMotion(const Program& program, const PerAxis<double>& start_m,
                                             const PerAxis<PlanLimits>& limits) {
  if (start_m.size() != limits.size() || limits.empty()) {
    throw ProgramError(program.name + ": one start position and one set of limits is needed for each axis");
  }
  const Place place{program, start_m, limits};
  std::shared_ptr<const MotionPlan> plan =
      std::visit([&](const auto& shape) { return Plan(shape, place); }, program.shape);
  // G-code is planned while it runs, and was asked before.
  const bool gcode = std::holds_alternative<GcodeMoves>(program.shape);
  if (!gcode && !(plan->duration_s() <= kLongestProgram_s)) RefuseDuration(program);
  if (program.torque) {
    plan = std::make_shared<TorquePlan>(std::move(plan), *program.torque, Find(place, program.torque->axis),
                                        limits, program.name);
  }
  return plan;
}

}  // namespace contour
