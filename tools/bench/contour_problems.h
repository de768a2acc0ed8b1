#pragma once

#include <cstddef>
#include <vector>

#include "control/qp_solver.h"

namespace contour::bench {

/// The problems that a two-axis contour MPC meets in closed loop, in order, with what they lead to.
struct ContourProblems {
  std::vector<QpProblem<2>> problems;
  std::vector<QpSolver<2>::Inputs> solutions;
  double limit_m_s2 = 0.0;    ///< of the command
  double share_active = 0.0;  ///< of the problems: some bound holds at the solution
};

/// A 35 Hz loop around a curved path at 0.2 ms of lag, kicked now and then by up to two millimetres, so
/// that a bound is active in about a fifth of the solves. The same every time.
ContourProblems MakeContourProblems(std::size_t horizon, std::size_t count);

}  // namespace contour::bench
