#pragma once

#include <Eigen/Core>
#include <vector>

#include "tools/diagnosis/problem.h"

namespace contour::diagnosis {

/// A maximum a posteriori point and the local picture there.
struct Fit {
  Point point;
  double cost = 0.0;  ///< |r|^2 + prior
  double prior = 0.0;
  std::vector<double> residual;  ///< white
  Eigen::MatrixXd jacobian;      ///< white; base terms, then amplitudes
  Eigen::MatrixXd covariance;    ///< of the same, noise of unit variance
  bool converged = false;
};

struct FitEffort {
  int most_steps = 8;
  int most_refreshes = 8;      ///< of the sensitivities
  double close_enough = 0.02;  ///< what one more step would promise at an end, of |r|^2
  bool covariance = true;      ///< of the end point; else sensitivities may be old
  const Fit* warm =
      nullptr;  ///< of the same noise and the same point less the last effect: its sensitivities serve
};

/// Gauss-Newton with the sensitivities kept while they serve. Noise is the problem's, held.
Fit FitPoint(const Problem& problem, Point start, const FitEffort& effort = {});

std::size_t ParameterCount(const Point& point);

}  // namespace contour::diagnosis
