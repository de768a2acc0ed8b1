#include "control/two_inertia_law.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "control/motion_ahead.h"
#include "control/spring_law.h"

namespace contour {
namespace {

// A softened loop answers what its observer finds this much more slowly than it holds the axis.
constexpr double kSlower = 0.5;
// In which what two loops' forces differ by fades.
constexpr double kLeaves_s = 0.03;
// In which it is forgotten that commands had to last.
constexpr double kLasts_s = 0.05;

FrictionAhead Ahead(const FrictionPreview& friction, std::size_t index) noexcept {
  if (friction.empty()) return {};
  return friction[std::min(index, friction.size() - 1)];
}

/// Of a force, by the drive's lag, over a share of the period.
double Kept(const ControlledAxis& axis, double share, double period_s) {
  return axis.lag_s > 0.0 ? std::exp(-share * period_s / axis.lag_s) : 0.0;
}

/// The torque filter, begun at rest.
double Filtered_N(const Biquad& b, double force_N, bool begins, std::array<double, 4>& state) noexcept {
  auto& [x1, x2, y1, y2] = state;
  if (begins) x1 = x2 = y1 = y2 = force_N;
  const double filtered_N = b.b0 * force_N + b.b1 * x1 + b.b2 * x2 - b.a1 * y1 - b.a2 * y2;
  x2 = x1;
  x1 = force_N;
  y2 = y1;
  y1 = filtered_N;
  return filtered_N;
}

const TwoInertiaLoop& Required(const std::optional<TwoInertiaLoop>& loop) {
  if (!loop) throw std::invalid_argument("two inertias: an axis has no loop");
  if (loop->whole_delay() == 0)
    throw std::invalid_argument("two inertias: a torque takes at least one period");
  return *loop;
}

}  // namespace

TwoInertiaLaw::Axis::Axis(const ControlledAxis& axis, const ControllerOptions& options, double period_s)
    : own(Required(axis.loop)),
      softer(Required(axis.softer_loop)),
      scale(axis.scale_loop),
      softer_scale(axis.softer_scale_loop),
      feedforward(axis, options, period_s),
      mechanics(axis.mechanics),
      force_limit_N(axis.limits.force_N),
      left_kept(std::exp(-period_s / kLeaves_s)),
      lag_kept(Kept(axis, 1.0 - own.late_share, period_s)),
      lag_kept_late(Kept(axis, own.late_share, period_s)),
      slow_share(1.0 -
                 std::exp(-2.0 * std::numbers::pi * kSlower * options.softer * axis.regulator_Hz * period_s)),
      standstill(axis.standstill) {}

TwoInertiaLaw::TwoInertiaLaw(const PerAxis<ControlledAxis>& axes, const ControllerOptions& options,
                             double period_s)
    : period_s_(period_s), lasts_kept_(std::exp(-period_s / kLasts_s)) {
  std::size_t queued = 1;
  for (const ControlledAxis& axis : axes) {
    axes_.emplace_back(axis, options, period_s);
    queued = std::max(queued, axes_.back().own.queued);
  }
  // One interval per command under way, and the wind-up's derivatives one more on either side.
  horizon_points_ = static_cast<int>(queued) + 4;
}

double TwoInertiaLaw::Axis::Deviation_N(const TwoInertiaLoop& loop, const LoopMotion& motion,
                                        const LoopMotion& wanted, const SpringShares& share) const noexcept {
  double deviation_N = 0.0;
  for (std::size_t i = 0; i < kLoopMotion; ++i)
    deviation_N += (i == 0 || i == 2 ? share.position : share.velocity) * loop.regulator_motion[i] *
                   (motion[i] - wanted[i]);
  for (std::size_t i = 0; i < loop.queued; ++i) {
    const std::size_t age = loop.queued - 1 - i;
    deviation_N += share.velocity * loop.regulator_queue[i] * (sent_N[age] - planned_N[age]);
  }
  return deviation_N;
}

void TwoInertiaLaw::Axis::Forget() noexcept {
  planned_N = grid_N = sent_N = {};
  led_N = wound_m = lead_m = slow_N = 0.0;
  standstill.Forget();
  left_N = 0.0;
  by_scale = sprung = false;
  filter = {};
  steps = 0;
}

void TwoInertiaLaw::Reset() noexcept {
  for (Axis& axis : axes_) axis.Forget();
  lasts_periods_ = 1.0;
}

// From the sample before to this one. What is not known of the past was as sent, so that it deviates by
// nothing.
void TwoInertiaLaw::Advance(Axis& a, double sent_N) const noexcept {
  if (a.steps == 0) {
    a.planned_N.fill(sent_N);
    a.grid_N.fill(sent_N);
    a.sent_N.fill(sent_N);
    a.led_N = sent_N;
    return;
  }
  std::shift_right(a.sent_N.begin(), a.sent_N.end(), 1);
  a.sent_N[0] = sent_N;
  if (a.own.late_share > 0.0) {
    const double late_N = a.planned_N[a.own.queued];
    a.led_N = late_N + a.lag_kept_late * (a.led_N - late_N);
  }
  const double acted_N = a.planned_N[a.own.whole_delay()];
  a.led_N = acted_N + a.lag_kept * (a.led_N - acted_N);
}

// The command before has lasted through the periods in which nothing was sent.
void TwoInertiaLaw::CatchUp(const ControlInput& input) noexcept {
  const double skipped = input.skipped;
  lasts_periods_ = std::max(1.0 + skipped, 1.0 + lasts_kept_ * (lasts_periods_ - 1.0));
  for (std::uint32_t s = 0; s < input.skipped; ++s)
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      Axis& a = axes_[i];
      Advance(a, input.previous_force_N[i]);
      std::shift_right(a.grid_N.begin(), a.grid_N.end(), 1);
      std::shift_right(a.planned_N.begin(), a.planned_N.end(), 1);
    }
}

// Planned for whole periods; what acts late by a share of one is of the two that it reaches into.
double TwoInertiaLaw::Feedforward_N(Axis& a, const AxisHorizon& reference, const FrictionPreview& friction,
                                    double& target_m) const noexcept {
  AxisPlan plan;
  const std::size_t last = a.own.whole_delay() - 1;
  const double mass_kg = a.mechanics.mass_kg, late = a.own.late_share;
  a.feedforward.Plan(reference, friction, a.grid_N[last] / mass_kg, a.own.queued, plan);
  target_m = plan.target_position_m;
  const double grid_N = plan.command_m_s2[last] * mass_kg;
  std::shift_right(a.grid_N.begin(), a.grid_N.end(), 1);
  a.grid_N[0] = grid_N;
  return late > 0.0 ? grid_N + late * (plan.command_m_s2[last + 1] * mass_kg - grid_N) : grid_N;
}

// Where the axis is to be at the sample, as the observer sees it: of a lead beside the commissioned wind-up
// it does not know, and takes it for the table's; with the scale it knows the table.
LoopMotion TwoInertiaLaw::Wanted(Axis& a, const AxisHorizon& reference, const FrictionPreview& friction,
                                 bool by_scale) const noexcept {
  const Mechanics& m = a.mechanics;
  const auto wound_m = [&](std::size_t n) {
    return (Ahead(friction, n).node_N + m.table_mass_kg * PointAt(reference, n).acceleration_m_s2) /
           m.stiffness_N_m;
  };
  const double now_m = wound_m(0), lead_now_m = Ahead(friction, 0).lead_m;
  const double before_m = a.steps == 0 ? now_m : a.wound_m;
  const double lead_before_m = a.steps == 0 ? lead_now_m : a.lead_m;
  const double span_s = a.steps == 0 ? period_s_ : 2.0 * period_s_;
  const double winding_m_s = (wound_m(1) - before_m) / span_s;
  const double leading_m_s = by_scale ? 0.0 : (Ahead(friction, 1).lead_m - lead_before_m) / span_s;
  a.wound_m = now_m;
  a.lead_m = lead_now_m;
  const double lead_m = by_scale ? 0.0 : lead_now_m;
  const ReferencePoint& r = PointAt(reference, 0);
  const double table_m = r.position_m + lead_m, table_m_s = r.velocity_m_s + leading_m_s;
  return {table_m + now_m, table_m_s + winding_m_s, table_m, table_m_s, a.led_N};
}

double TwoInertiaLaw::Feedback_N(Axis& a, const LoopMotion& wanted, const AxisEstimate& estimate,
                                 bool begins) const noexcept {
  const TwoInertiaLoop& loop = a.Loop(estimate.by_scale, softer_);
  a.slow_N += a.slow_share * (estimate.disturbance_N - a.slow_N);
  const double deviation_N = a.Deviation_N(loop, estimate.motion, wanted, {});
  // A command that lasts for several periods pushes for as many.
  const double share = 1.0 / lasts_periods_;
  const double quick_N = softer_ ? 0.0 : share * (estimate.disturbance_N - a.slow_N);
  const double force_N = loop.disturbance_to_command * (a.slow_N + quick_N) - share * deviation_N;
  return Filtered_N(loop.filter, force_N, begins, a.filter);
}

void TwoInertiaLaw::Spring(std::size_t axis, const ControlInput& input, ControlOutput& output) noexcept {
  Axis& a = axes_[axis];
  if (!a.sprung) a.Forget();
  a.sprung = true;
  Advance(a, input.previous_force_N[axis]);
  const AxisHorizon& reference = input.reference[axis];
  const ReferencePoint &r = PointAt(reference, 0), &ahead = PointAt(reference, 1);
  const TwoInertiaLoop& loop = a.Loop(input.estimate[axis].by_scale, softer_);
  const SpringShares share = SharesOfSpring(loop, ahead.spring_N_m);
  const double against_N = SpringLaw::AgainstStated_N(input, axis);
  const double table_N = axis < input.stated.size() ? input.stated[axis].table_N : 0.0;
  const double motor_m = r.position_m - table_N / a.mechanics.stiffness_N_m;
  const LoopMotion wanted{motor_m, r.velocity_m_s, r.position_m, r.velocity_m_s, a.led_N};
  const double deviation_N = a.Deviation_N(loop, input.estimate[axis].motion, wanted, share);
  const double force_N =
      against_N + Filtered_N(loop.filter, -deviation_N / lasts_periods_, a.steps == 0, a.filter);
  std::shift_right(a.planned_N.begin(), a.planned_N.end(), 1);
  a.planned_N[0] = against_N + ahead.extra_torque_Nm / a.mechanics.radius_m_rad;
  a.steps = 1;
  output.target_position_m[axis] = ahead.position_m;
  output.feedforward_N[axis] = against_N;
  output.force_N[axis] = std::clamp(force_N, -a.force_limit_N, a.force_limit_N);
  output.limit[axis] = std::abs(force_N) > a.force_limit_N ? Reason::kTorqueLimit : Reason::kNone;
}

void TwoInertiaLaw::LeaveScale(Axis& a, double force_N) const noexcept {
  a.left_N = a.sent_N[0] - force_N;
  a.standstill.Forget();
}

void TwoInertiaLaw::Step(const ControlInput& input, ControlOutput& output) noexcept {
  output.iterations = 0;
  CatchUp(input);
  const auto points = static_cast<std::size_t>(horizon_points_);
  const bool any_moves = AnyMovesAhead(input, points);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& a = axes_[i];
    if (SpringLaw::Holds(input, i)) {
      Spring(i, input, output);
      continue;
    }
    if (a.sprung) a.Forget();
    const AxisHorizon& reference = Reference(input)[i];
    const FrictionPreview& friction = input.friction[i];
    Advance(a, input.previous_force_N[i]);
    const LoopMotion wanted = Wanted(a, reference, friction, input.estimate[i].by_scale);
    const bool leaves = a.by_scale && !input.estimate[i].by_scale;
    a.by_scale = input.estimate[i].by_scale;
    double feedback_N = Feedback_N(a, wanted, input.estimate[i], a.steps == 0 || leaves);
    const double planned_N = Feedforward_N(a, reference, friction, output.target_position_m[i]);
    std::shift_right(a.planned_N.begin(), a.planned_N.end(), 1);
    a.planned_N[0] = planned_N;
    a.steps = 1;
    if (leaves) LeaveScale(a, planned_N + feedback_N);
    feedback_N += a.left_N;
    a.left_N *= a.left_kept;
    const double beyond_m = input.estimate[i].motion[2] - wanted[2];
    const Standstill::Motion motion = MotionAhead(reference, points, any_moves);
    const double force_N = a.standstill.Step(beyond_m, a.sent_N[0], motion).value_or(planned_N + feedback_N);
    output.feedforward_N[i] = planned_N;
    output.force_N[i] = std::clamp(force_N, -a.force_limit_N, a.force_limit_N);
    output.limit[i] = std::abs(force_N) > a.force_limit_N ? Reason::kTorqueLimit : Reason::kNone;
  }
}

}  // namespace contour
