#include "control/qp_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contour {
namespace {

// Bounds and multipliers count as violated beyond this fraction of the width of the bounds.
constexpr double kTolerance = 1e-10;
constexpr int kPrimalDualSteps = 4;
constexpr std::size_t kUnchanged = static_cast<std::size_t>(-1);

}  // namespace

template <std::size_t Axes>
void QpSolver<Axes>::HoldValues(const Problem& problem, const Active& active) noexcept {
  for (std::size_t j = 0; j < problem.horizon; ++j) {
    for (std::size_t i = 0; i < Axes; ++i) {
      const int at = active[j][i].value;
      holding_[j].how[i] = at == 0 ? Hold::kFree : Hold::kFixed;
      holding_[j].value[i] = at < 0 ? problem.stage[j].lowest[i] : problem.stage[j].highest[i];
    }
  }
}

// Bounds broken become active, active ones that pull the wrong way free. Returns the last stage changed.
template <std::size_t Axes>
std::size_t QpSolver<Axes>::UpdateActive(const Problem& problem, const Inputs& input, const Inputs& gradient,
                                         Active& active) const noexcept {
  std::size_t changed = kUnchanged;
  for (std::size_t j = 0; j < problem.horizon; ++j) {
    const QpStage<Axes>& stage = problem.stage[j];
    for (std::size_t i = 0; i < Axes; ++i) {
      const double tolerance = kTolerance * (stage.highest[i] - stage.lowest[i]);
      const int now = active[j][i].value;
      int next = now;
      if (now == 0) {
        if (input[j][i] < stage.lowest[i] - tolerance) next = -1;
        if (input[j][i] > stage.highest[i] + tolerance) next = 1;
      } else if (now * gradient[j][i] > tolerance * riccati_.curvature(j, i)) {
        next = 0;
      }
      if (next != now) {
        active[j][i].value = static_cast<std::int8_t>(next);
        changed = j;
      }
    }
  }
  return changed;
}

template <std::size_t Axes>
void QpSolver<Axes>::Forget() noexcept {
  best_cost_ = std::numeric_limits<double>::infinity();
}

template <std::size_t Axes>
void QpSolver<Axes>::RememberClipped(const Problem& problem, const Inputs& input) noexcept {
  trial_ = input;
  Active active;
  ClipForward<Axes>(problem, trial_, active);
  const double cost = Cost<Axes>(problem, trial_);
  if (cost < best_cost_) {
    best_ = trial_;
    best_active_ = active;
    best_cost_ = cost;
  }
}

template <std::size_t Axes>
bool QpSolver<Axes>::PrimalDual(const Problem& problem, int cap, Active& active, Inputs& input,
                                QpReport& report) noexcept {
  std::size_t top = problem.horizon - 1;
  for (int step = 0; step < kPrimalDualSteps && report.iterations < cap; ++step) {
    HoldValues(problem, active);
    riccati_.Factor(problem, holding_, top);
    riccati_.RollOut(problem, holding_, input, gradient_);
    ++report.iterations;
    top = UpdateActive(problem, input, gradient_, active);
    if (top == kUnchanged) return true;
    RememberClipped(problem, input);
  }
  return false;
}

template <std::size_t Axes>
void QpSolver<Axes>::ProjectedNewton(const Problem& problem, int cap, Active& active,
                                     QpReport& report) noexcept {
  Inputs& input = best_;
  double& cost = best_cost_;
  report.status = QpStatus::kCap;
  double nearness = 0.1;  // of the bounds' width; shrinks when a step had to be shortened
  while (report.iterations < cap) {
    Gradient<Axes>(problem, input, gradient_);
    for (std::size_t j = 0; j < problem.horizon; ++j) {
      const QpStage<Axes>& stage = problem.stage[j];
      for (std::size_t i = 0; i < Axes; ++i) {
        const double near = nearness * (stage.highest[i] - stage.lowest[i]);
        active[j][i].value = 0;
        if (gradient_[j][i] > 0.0 && input[j][i] - stage.lowest[i] <= near) active[j][i].value = -1;
        if (gradient_[j][i] < 0.0 && stage.highest[i] - input[j][i] <= near) active[j][i].value = 1;
      }
    }
    HoldValues(problem, active);
    riccati_.Factor(problem, holding_, problem.horizon - 1);
    Inputs held_gradient;
    riccati_.RollOut(problem, holding_, target_, held_gradient);
    ++report.iterations;
    if (UpdateActive(problem, target_, held_gradient, active) == kUnchanged) {
      input = target_;
      report.status = QpStatus::kOptimal;
      return;
    }
    bool descended = false;
    for (double length = 1.0; length > 1e-4; length *= 0.5) {
      double slope = 0.0;
      for (std::size_t j = 0; j < problem.horizon; ++j) {
        for (std::size_t i = 0; i < Axes; ++i) {
          trial_[j][i] = std::clamp(input[j][i] + length * (target_[j][i] - input[j][i]),
                                    problem.stage[j].lowest[i], problem.stage[j].highest[i]);
          slope += gradient_[j][i] * (trial_[j][i] - input[j][i]);
        }
      }
      const double trial_cost = Cost<Axes>(problem, trial_);
      if (trial_cost <= cost + 1e-4 * slope && trial_cost < cost) {
        input = trial_;
        cost = trial_cost;
        descended = true;
        break;
      }
    }
    if (!descended) {
      if (nearness < 1e-9) {
        report.status = QpStatus::kStalled;
        return;
      }
      nearness *= 1e-2;
    }
  }
}

template <std::size_t Axes>
bool QpSolver<Axes>::StepsWithin(const Problem& problem, const Inputs& input) const noexcept {
  for (std::size_t i = 0; i < Axes; ++i) {
    if (!problem.has_rate_limit[i]) continue;
    for (std::size_t j = 1; j < problem.horizon; ++j) {
      const QpStage<Axes>& stage = problem.stage[j];
      const double tolerance = kTolerance * (stage.highest[i] - stage.lowest[i]);
      const double step = input[j][i] - input[j - 1][i];
      if (step < stage.lowest_step[i] - tolerance || step > stage.highest_step[i] + tolerance) return false;
    }
  }
  return true;
}

// Optimum of the held problem, and the multipliers there.
template <std::size_t Axes>
void QpSolver<Axes>::SolveHeld(const Problem& problem, const Active& active, Inputs& input) noexcept {
  HoldActive<Axes>(problem, active, holding_);
  riccati_.Factor(problem, holding_, problem.horizon - 1);
  riccati_.RollOut(problem, holding_, input, gradient_);
  Gradient<Axes>(problem, input, gradient_);
  FindMultipliers<Axes>(problem, active, gradient_, multipliers_);
}

// As UpdateActive, for both kinds of bounds. Says whether anything changed.
template <std::size_t Axes>
bool QpSolver<Axes>::UpdateWithSteps(const Problem& problem, const Inputs& input, Active& active) noexcept {
  bool changed = false;
  for (std::size_t j = 0; j < problem.horizon; ++j) {
    const QpStage<Axes>& stage = problem.stage[j];
    for (std::size_t i = 0; i < Axes; ++i) {
      const double tolerance = kTolerance * (stage.highest[i] - stage.lowest[i]);
      const double pull = tolerance * riccati_.curvature(j, i);
      const ActiveBounds now = active[j][i];
      ActiveBounds next = now;
      if (now.value * multipliers_.value[j][i] < -pull) next.value = 0;
      if (now.step * multipliers_.step[j][i] < -pull) next.step = 0;
      if (input[j][i] < stage.lowest[i] - tolerance) next.value = -1;
      if (input[j][i] > stage.highest[i] + tolerance) next.value = 1;
      if (j > 0 && problem.has_rate_limit[i]) {
        const double step = input[j][i] - input[j - 1][i];
        if (step < stage.lowest_step[i] - tolerance) next.step = -1;
        if (step > stage.highest_step[i] + tolerance) next.step = 1;
      }
      changed = changed || next.value != now.value || next.step != now.step;
      active[j][i] = next;
    }
  }
  if (changed) MakeIndependent<Axes>(problem, active);
  return changed;
}

template <std::size_t Axes>
bool QpSolver<Axes>::PrimalDualWithSteps(const Problem& problem, int cap, Active& active, Inputs& input,
                                         QpReport& report) noexcept {
  MakeIndependent<Axes>(problem, active);
  for (int step = 0; step < kPrimalDualSteps && report.iterations < cap; ++step) {
    SolveHeld(problem, active, input);
    ++report.iterations;
    if (!UpdateWithSteps(problem, input, active)) return true;
    RememberClipped(problem, input);
  }
  return false;
}

template <std::size_t Axes>
typename QpSolver<Axes>::Blocking QpSolver<Axes>::FindBlocking(const Problem& problem, const Active& active,
                                                               const Inputs& from,
                                                               const Inputs& to) const noexcept {
  Blocking first;
  const auto look = [&first](double at, double change, double lowest, double highest, std::size_t j,
                             std::size_t i, bool is_step) {
    if (change == 0.0) return;
    const double room = change < 0.0 ? lowest - at : highest - at;
    const double length = std::max(0.0, room / change);
    if (length >= first.length) return;
    const auto side = static_cast<std::int8_t>(change < 0.0 ? -1 : 1);
    first = {length, j, i, is_step ? ActiveBounds{0, side} : ActiveBounds{side, 0}};
  };
  for (std::size_t i = 0; i < Axes; ++i) {
    // Within a run without anchor all move alike, and an anchored run stands: rounding is no movement.
    for (std::size_t j = 0; j < problem.horizon; ++j) {
      const QpStage<Axes>& stage = problem.stage[j];
      if (holding_[j].how[i] != Hold::kFixed) {
        look(from[j][i], to[j][i] - from[j][i], stage.lowest[i], stage.highest[i], j, i, false);
      }
      if (j == 0 || !problem.has_rate_limit[i] || active[j][i].step != 0) continue;
      if (holding_[j].how[i] == Hold::kFixed && holding_[j - 1].how[i] == Hold::kFixed) continue;
      const double at = from[j][i] - from[j - 1][i];
      look(at, to[j][i] - to[j - 1][i] - at, stage.lowest_step[i], stage.highest_step[i], j, i, true);
    }
  }
  return first;
}

// Frees the active bound whose multiplier has the wrong sign by most; false when all are right.
template <std::size_t Axes>
bool QpSolver<Axes>::DropWorst(const Problem& problem, Active& active) noexcept {
  double worst = 0.0;
  ActiveBounds* found = nullptr;
  bool found_step = false;
  for (std::size_t j = 0; j < problem.horizon; ++j) {
    const QpStage<Axes>& stage = problem.stage[j];
    for (std::size_t i = 0; i < Axes; ++i) {
      const double pull = kTolerance * (stage.highest[i] - stage.lowest[i]) * riccati_.curvature(j, i);
      const double value = active[j][i].value * multipliers_.value[j][i];
      const double step = active[j][i].step * multipliers_.step[j][i];
      if (value < std::min(worst, -pull)) {
        worst = value;
        found = &active[j][i];
        found_step = false;
      }
      if (step < std::min(worst, -pull)) {
        worst = step;
        found = &active[j][i];
        found_step = true;
      }
    }
  }
  if (found == nullptr) return false;
  (found_step ? found->step : found->value) = 0;
  return true;
}

template <std::size_t Axes>
void QpSolver<Axes>::PrimalActiveSet(const Problem& problem, int cap, Active& active,
                                     QpReport& report) noexcept {
  Inputs& input = best_;
  double& cost = best_cost_;
  active = best_active_;
  report.status = QpStatus::kCap;
  while (report.iterations < cap) {
    SolveHeld(problem, active, target_);
    ++report.iterations;
    const Blocking blocking = FindBlocking(problem, active, input, target_);
    if (blocking.length >= 1.0) {
      input = target_;
      cost = Cost<Axes>(problem, input);
      if (!DropWorst(problem, active)) {
        report.status = QpStatus::kOptimal;
        return;
      }
      continue;
    }
    for (std::size_t j = 0; j < problem.horizon; ++j) {
      for (std::size_t i = 0; i < Axes; ++i) {
        input[j][i] += blocking.length * (target_[j][i] - input[j][i]);
      }
    }
    ActiveBounds& met = active[blocking.stage][blocking.axis];
    if (blocking.bound.value != 0) met.value = blocking.bound.value;
    if (blocking.bound.step != 0) met.step = blocking.bound.step;
    cost = Cost<Axes>(problem, input);
    // The way to the optimum of the held problem met one bound; its clipped end meets many and is often
    // better.
    Active clipped;
    ClipForward<Axes>(problem, target_, clipped);
    const double clipped_cost = Cost<Axes>(problem, target_);
    if (clipped_cost < cost) {
      input = target_;
      active = clipped;
      cost = clipped_cost;
    }
  }
}

template <std::size_t Axes>
QpReport QpSolver<Axes>::Solve(Problem& problem, int iteration_cap, Active& active, Inputs& input) noexcept {
  QpReport report;
  bool rate_limited = false;
  bool guess_has_steps = false;
  for (std::size_t i = 0; i < Axes; ++i) {
    rate_limited = rate_limited || problem.has_rate_limit[i];
    for (std::size_t j = 0; j < problem.horizon; ++j)
      guess_has_steps = guess_has_steps || active[j][i].step != 0;
  }
  if (rate_limited) FoldFirstStep<Axes>(problem);
  Forget();
  if (!rate_limited || !guess_has_steps) {
    if (PrimalDual(problem, iteration_cap, active, input, report)) {
      if (!rate_limited || StepsWithin(problem, input)) return report;
      RememberClipped(problem, input);
    } else if (!rate_limited) {
      ProjectedNewton(problem, iteration_cap, active, report);
      input = best_;
      return report;
    }
  }
  if (!PrimalDualWithSteps(problem, iteration_cap, active, input, report)) {
    PrimalActiveSet(problem, iteration_cap, active, report);
    input = best_;
  }
  return report;
}

template class QpSolver<1>;
template class QpSolver<2>;
template class QpSolver<3>;

}  // namespace contour
