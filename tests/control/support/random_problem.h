#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "control/lqr_terminal.h"
#include "control/qp_problem.h"

namespace contour::test {

/// Deviations of a contouring machine along a curved path, kicked hard enough that anything from none to
/// nearly all of the bounds is active.
template <std::size_t Axes>
QpProblem<Axes> RandomProblem(std::mt19937_64& random, std::size_t horizon, bool rate_limits) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto log_uniform = [&](double low, double high) {
    return low * std::pow(high / low, 0.5 * (1.0 + unit(random)));
  };
  QpProblem<Axes> problem;
  problem.horizon = horizon;
  const double contour_weight = std::pow(2.0 * std::numbers::pi * log_uniform(15.0, 80.0), 4);
  const double lag_weight = std::pow(2.0 * std::numbers::pi * log_uniform(15.0, 80.0), 4);
  std::array<TerminalFactor, Axes> factor;
  for (std::size_t i = 0; i < Axes; ++i) {
    problem.dynamics[i] = DiscretizeAxis(1e-3, log_uniform(5e-5, 4e-4), log_uniform(0.1, 20.0));
    problem.effort[i] = 1.0;
    factor[i] = LqrTerminal(problem.dynamics[i], contour_weight, 1.0);
    problem.has_rate_limit[i] = rate_limits;
  }
  for (std::size_t i = 0; i < Axes; ++i) {
    problem.terminal[i][i] = factor[i].pp * factor[i].pp;
    problem.terminal[i][Axes + i] = problem.terminal[Axes + i][i] = factor[i].pp * factor[i].vp;
    problem.terminal[Axes + i][Axes + i] = factor[i].vp * factor[i].vp + factor[i].vv * factor[i].vv;
  }
  const double kick = log_uniform(1e-8, 2e-3);
  const double bound = log_uniform(2.0, 20.0);
  const double step = bound * log_uniform(0.02, 1.0);
  for (std::size_t i = 0; i < Axes; ++i) {
    problem.start.position[i] = kick * unit(random);
    problem.start.velocity[i] = 50.0 * kick * unit(random);
    problem.previous[i] = 0.9 * bound * unit(random);
  }
  std::array<double, Axes> planned_before{};
  double angle = std::numbers::pi * unit(random);
  const double turn = 0.3 * unit(random);
  for (std::size_t j = 0; j < horizon; ++j) {
    QpStage<Axes>& stage = problem.stage[j];
    angle += turn;
    std::array<double, Axes> tangent{};
    tangent[0] = std::cos(angle);
    if constexpr (Axes > 1) tangent[1] = std::sin(angle);
    for (std::size_t i = 0; i < Axes; ++i) {
      for (std::size_t k = 0; k < Axes; ++k) {
        stage.weight[i][k] =
            (i == k ? contour_weight : 0.0) + (lag_weight - contour_weight) * tangent[i] * tangent[k];
      }
      stage.position_defect[i] = 1e-9 * unit(random);
      stage.velocity_defect[i] = 1e-6 * unit(random);
      const double planned = 0.3 * bound * std::sin(0.2 * static_cast<double>(j) + static_cast<double>(i));
      const double planned_step = planned - planned_before[i];
      planned_before[i] = planned;
      stage.lowest[i] = -bound - planned;
      stage.highest[i] = bound - planned;
      stage.lowest_step[i] = -step - planned_step;
      stage.highest_step[i] = step - planned_step;
    }
  }
  return problem;
}

}  // namespace contour::test
