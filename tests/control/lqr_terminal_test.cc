#include "control/lqr_terminal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "control/riccati.h"

namespace contour {
namespace {

double Weight(double bandwidth_Hz) { return std::pow(2.0 * std::numbers::pi * bandwidth_Hz, 4); }

QpProblem<1> Problem(double bandwidth_Hz, std::size_t horizon) {
  QpProblem<1> problem;
  problem.horizon = horizon;
  problem.dynamics[0] = DiscretizeAxis(1e-3, 2e-4, 5.0);
  problem.effort[0] = 1.0;
  problem.start.position[0] = 1e-4;
  problem.start.velocity[0] = -3e-3;
  for (auto& stage : problem.stage) stage.weight[0][0] = Weight(bandwidth_Hz);
  const TerminalFactor f = LqrTerminal(problem.dynamics[0], Weight(bandwidth_Hz), 1.0);
  problem.terminal = {{{f.pp * f.pp, f.pp * f.vp}, {f.pp * f.vp, f.vp * f.vp + f.vv * f.vv}}};
  return problem;
}

// With the terminal weight the horizon's length changes nothing: the cost-to-go is that of an infinite one.
TEST(LqrTerminal, MakesTheFirstInputIndependentOfTheHorizon) {
  for (const double bandwidth : {5.0, 42.0, 150.0}) {
    auto riccati = std::make_unique<Riccati<1>>();
    Riccati<1>::Holding free{};
    Riccati<1>::Inputs input{}, gradient{};
    double first = 0.0;
    for (const std::size_t horizon : {1U, 5U, 20U, 40U}) {
      const QpProblem<1> problem = Problem(bandwidth, horizon);
      riccati->Factor(problem, free, horizon - 1);
      riccati->RollOut(problem, free, input, gradient);
      if (horizon == 1) first = input[0][0];
      EXPECT_NEAR(input[0][0], first, 1e-9 * std::abs(first)) << bandwidth << " Hz, horizon " << horizon;
    }
  }
}

TEST(LqrTerminal, LeadsToTheBandwidthItIsNamedAfter) {
  // A second-order Butterworth loop: from rest the error crosses zero at 3 pi / (4 omega / sqrt 2).
  const double bandwidth = 10.0;
  auto riccati = std::make_unique<Riccati<1>>();
  QpProblem<1> problem = Problem(bandwidth, 40);
  problem.start.velocity[0] = 0.0;
  DriftState<1> s = problem.start;
  Riccati<1>::Holding free{};
  Riccati<1>::Inputs input{}, gradient{};
  int steps = 0;
  for (; s.position[0] > 0.0 && steps < 1000; ++steps) {
    problem.start = s;
    riccati->Factor(problem, free, problem.horizon - 1);
    riccati->RollOut(problem, free, input, gradient);
    s = Advance(problem, s, 0, input[0]);
  }
  const double expected_s =
      0.75 * std::numbers::pi * std::numbers::sqrt2 / (2.0 * std::numbers::pi * bandwidth);
  EXPECT_NEAR(steps * 1e-3, expected_s, 0.05 * expected_s);
}

TEST(LqrTerminal, RefusesWeightsThatAreNone) {
  const AxisDynamics d = DiscretizeAxis(1e-3, 2e-4, 0.0);
  EXPECT_THROW(LqrTerminal(d, 0.0, 1.0), std::invalid_argument);
  EXPECT_THROW(LqrTerminal(d, 1.0, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace contour
