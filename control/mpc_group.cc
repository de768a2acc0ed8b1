#include "control/mpc_group.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "control/motion_ahead.h"
#include "control/spring_law.h"

namespace contour {
template <std::size_t Axes>
MpcGroup<Axes>::MpcGroup(const MpcConfig& config, const ControllerOptions& options,
                         const PerAxis<ControlledAxis>& axes, std::size_t first, double period_s)
    : config_(config), first_(first), period_s_(period_s) {
  if (config.horizon < 1 || config.horizon > static_cast<int>(kMaxHorizon)) {
    throw std::invalid_argument("mpc: the horizon must be 1 to 40 cycles");
  }
  if (config.iteration_cap < 1) throw std::invalid_argument("mpc: the iteration cap must be positive");
  problem_.horizon = static_cast<std::size_t>(config.horizon);
  for (std::size_t i = 0; i < Axes; ++i) {
    const ControlledAxis& axis = axes[first + i];
    if (!(axis.limits.force_N > 0.0)) throw std::invalid_argument("mpc: the torque limit must be positive");
    feedforward_.emplace_back(axis, options, period_s);
    mass_kg_[i] = axis.mechanics.mass_kg;
    bound_m_s2_[i] = axis.limits.force_N / mass_kg_[i];
    step_m_s2_[i] = axis.limits.force_rate_N_s * period_s / mass_kg_[i];
    problem_.has_rate_limit[i] = step_m_s2_[i] < 2.0 * bound_m_s2_[i];
    problem_.dynamics[i] = feedforward_[i].dynamics();
    problem_.effort[i] = 1.0;
    standstill_[i] = Standstill(axis.standstill);
  }
  for (const double share : {1.0, options.softer})
    weights_.emplace_back(share * config.contour_bandwidth_Hz, share * config.lag_bandwidth_Hz,
                          config.rest_velocity_um_s * 1e-6, problem_.dynamics);
  Reset();
}

template <std::size_t Axes>
void MpcGroup<Axes>::Reset() noexcept {
  active_ = {};
  solution_ = {};
  has_planned_ = false;
  for (Standstill& s : standstill_) s.Forget();
}

template <std::size_t Axes>
void MpcGroup<Axes>::BuildAxis(const ControlInput& input, std::size_t i) noexcept {
  const std::size_t axis = first_ + i;
  const double sent = input.previous_force_N[axis] / mass_kg_[i];
  if (!has_planned_) planned_m_s2_[i] = sent;
  AxisPlan& plan = plan_[i];
  feedforward_[i].Plan(Reference(input)[axis], input.friction[axis], planned_m_s2_[i], problem_.horizon,
                       plan);

  const AxisEstimate& estimate = input.estimate[axis];
  const AxisDynamics& d = problem_.dynamics[i];
  const double position = estimate.predicted_position_m - plan.start_position_m;
  const double velocity = estimate.predicted_velocity_m_s - plan.start_velocity_m_s;
  const double previous = sent - planned_m_s2_[i];
  problem_.previous[i] = previous;
  problem_.start.position[i] = position + d.position_from_velocity * velocity +
                               d.position_from_previous * previous + plan.position_defect_m[0];
  problem_.start.velocity[i] =
      d.velocity_kept * velocity + d.velocity_from_previous * previous + plan.velocity_defect_m_s[0];

  double before = planned_m_s2_[i];
  for (std::size_t j = 0; j < problem_.horizon; ++j) {
    QpStage<Axes>& stage = problem_.stage[j];
    const double planned = plan.command_m_s2[j];
    stage.position_defect[i] = plan.position_defect_m[j];
    stage.velocity_defect[i] = plan.velocity_defect_m_s[j];
    stage.lowest[i] = -bound_m_s2_[i] - planned;
    stage.highest[i] = bound_m_s2_[i] - planned;
    stage.lowest_step[i] = -step_m_s2_[i] - (planned - before);
    stage.highest_step[i] = step_m_s2_[i] - (planned - before);
    before = planned;
  }
  planned_m_s2_[i] = plan.command_m_s2[0];
}

template <std::size_t Axes>
void MpcGroup<Axes>::ShiftWarmStart() noexcept {
  for (std::size_t j = 0; j + 1 < problem_.horizon; ++j) active_[j] = active_[j + 1];
}

template <std::size_t Axes>
void MpcGroup<Axes>::Step(const ControlInput& input, ControlOutput& output) noexcept {
  weights_[softer_ ? 1 : 0].Fill(Reference(input), first_, problem_);
  for (std::size_t i = 0; i < Axes; ++i) BuildAxis(input, i);
  const bool begins = !has_planned_;
  has_planned_ = true;
  ShiftWarmStart();
  const QpReport report = solver_.Solve(problem_, config_.iteration_cap, active_, solution_);
  Report(report, output);
  HoldAtRest(input, begins, output);
}

template <std::size_t Axes>
void MpcGroup<Axes>::HoldAtRest(const ControlInput& input, bool begins, ControlOutput& output) noexcept {
  const std::size_t points = problem_.horizon + 3;
  const bool any_moves = AnyMovesAhead(input, points);
  for (std::size_t i = 0; i < Axes; ++i) {
    const std::size_t axis = first_ + i;
    const Standstill::Motion motion = SpringLaw::Holds(input, axis)
                                          ? Standstill::Motion::kOwn
                                          : MotionAhead(Reference(input)[axis], points, any_moves);
    const double beyond_m = input.estimate[axis].predicted_position_m - plan_[i].start_position_m;
    if (begins && motion != Standstill::Motion::kOwn)
      standstill_[i].Begin(beyond_m, output.feedforward_N[axis]);
    const std::optional<double> held_N = standstill_[i].Step(beyond_m, input.previous_force_N[axis], motion);
    if (!held_N) continue;
    output.force_N[axis] = std::clamp(*held_N, -bound_m_s2_[i] * mass_kg_[i], bound_m_s2_[i] * mass_kg_[i]);
    output.limit[axis] = Reason::kNone;
  }
}

template <std::size_t Axes>
void MpcGroup<Axes>::Report(const QpReport& report, ControlOutput& output) noexcept {
  output.iterations += report.iterations;
  for (std::size_t i = 0; i < Axes; ++i) {
    const std::size_t axis = first_ + i;
    const double planned = plan_[i].command_m_s2[0];
    const double command = std::clamp(planned + solution_[0][i], -bound_m_s2_[i], bound_m_s2_[i]);
    output.force_N[axis] = command * mass_kg_[i];
    output.feedforward_N[axis] = planned * mass_kg_[i];
    output.target_position_m[axis] = plan_[i].target_position_m;
    output.limit[axis] = Reason::kNone;
    if (report.status != QpStatus::kOptimal) output.limit[axis] = Reason::kSolverCap;
    if (active_[0][i].value != 0) {
      // The solver folds the first step's bound into the first value's.
      const bool at_torque = std::abs(command) > (1.0 - 1e-9) * bound_m_s2_[i];
      output.limit[axis] = at_torque ? Reason::kTorqueLimit : Reason::kTorqueRateLimit;
    }
  }
}

template class MpcGroup<1>;
template class MpcGroup<2>;
template class MpcGroup<3>;

}  // namespace contour
