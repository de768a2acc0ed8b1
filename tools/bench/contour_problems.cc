#include "tools/bench/contour_problems.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "control/lqr_terminal.h"

namespace contour::bench {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr double kLimit_m_s2 = 21.0;  // 1.5 Nm on the example's axis
constexpr double kTurn_rad = 0.005;   // of the path's direction per period

double Weight(double bandwidth_Hz) { return std::pow(2.0 * std::numbers::pi * bandwidth_Hz, 4); }

QpProblem<2> Template(std::size_t horizon) {
  QpProblem<2> p;
  p.horizon = horizon;
  for (std::size_t i = 0; i < 2; ++i) {
    p.dynamics[i] = DiscretizeAxis(kPeriod_s, 2e-4, 5.0);
    p.effort[i] = 1.0;
    const TerminalFactor f = LqrTerminal(p.dynamics[i], Weight(35.0), 1.0);
    p.terminal[i][i] = f.pp * f.pp;
    p.terminal[i][2 + i] = p.terminal[2 + i][i] = f.pp * f.vp;
    p.terminal[2 + i][2 + i] = f.vp * f.vp + f.vv * f.vv;
  }
  return p;
}

/// Everything of the problem at cycle k but where the axes are.
void FillStages(std::size_t k, QpProblem<2>& p) {
  const double contour = Weight(35.0), lag = Weight(24.0);
  for (std::size_t j = 0; j < p.horizon; ++j) {
    const double angle = kTurn_rad * static_cast<double>(k + j);
    const double tangent[2] = {std::cos(angle), std::sin(angle)};
    QpStage<2>& stage = p.stage[j];
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t m = 0; m < 2; ++m)
        stage.weight[i][m] = (i == m ? contour : 0.0) + (lag - contour) * tangent[i] * tangent[m];
      const double planned = 0.1 * kLimit_m_s2 * tangent[1 - i];
      stage.lowest[i] = -kLimit_m_s2 - planned;
      stage.highest[i] = kLimit_m_s2 - planned;
    }
  }
}

}  // namespace

ContourProblems MakeContourProblems(std::size_t horizon, std::size_t count) {
  std::mt19937_64 random(20);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  ContourProblems out;
  out.limit_m_s2 = kLimit_m_s2;
  auto solver = std::make_unique<QpSolver<2>>();
  QpSolver<2>::Active active{};
  QpProblem<2> p = Template(horizon);
  double position[2] = {}, velocity[2] = {}, previous[2] = {};
  for (std::size_t k = 0; k < count; ++k) {
    FillStages(k, p);
    for (std::size_t i = 0; i < 2; ++i) {
      if (k % 60 == 30 * i) position[i] += 2e-3 * unit(random);
      velocity[i] += 1e-4 * normal(random);
      const AxisDynamics& d = p.dynamics[i];
      p.previous[i] = previous[i];
      p.start.position[i] =
          position[i] + d.position_from_velocity * velocity[i] + d.position_from_previous * previous[i];
      p.start.velocity[i] = d.velocity_kept * velocity[i] + d.velocity_from_previous * previous[i];
    }
    for (std::size_t j = 0; j + 1 < horizon; ++j) active[j] = active[j + 1];
    out.problems.push_back(p);
    QpSolver<2>::Inputs input{};
    solver->Solve(p, 200, active, input);
    out.solutions.push_back(input);
    bool any = false;
    for (std::size_t j = 0; j < horizon; ++j) any = any || active[j][0].value != 0 || active[j][1].value != 0;
    out.share_active += any ? 1.0 / static_cast<double>(count) : 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      previous[i] = input[0][i];
      position[i] = p.start.position[i] + p.dynamics[i].position_from_command * previous[i];
      velocity[i] = p.start.velocity[i] + p.dynamics[i].velocity_from_command * previous[i];
    }
  }
  return out;
}

}  // namespace contour::bench
