#include "control/qp_solver.h"

#include <algorithm>
#include <cmath>

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
  }
  return false;
}

template <std::size_t Axes>
void QpSolver<Axes>::ProjectedNewton(const Problem& problem, int cap, Active& active, Inputs& input,
                                     QpReport& report) noexcept {
  const auto project = [&problem](Inputs& u) {
    for (std::size_t j = 0; j < problem.horizon; ++j) {
      for (std::size_t i = 0; i < Axes; ++i) {
        u[j][i] = std::clamp(u[j][i], problem.stage[j].lowest[i], problem.stage[j].highest[i]);
      }
    }
  };
  project(input);
  double cost = Cost<Axes>(problem, input);
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
QpReport QpSolver<Axes>::Solve(const Problem& problem, int iteration_cap, Active& active,
                               Inputs& input) noexcept {
  QpReport report;
  if (!PrimalDual(problem, iteration_cap, active, input, report)) {
    ProjectedNewton(problem, iteration_cap, active, input, report);
  }
  return report;
}

template class QpSolver<1>;
template class QpSolver<2>;
template class QpSolver<3>;

}  // namespace contour
