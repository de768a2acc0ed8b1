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

/// Gauss-Newton with the sensitivities kept while they serve. Noise is the problem's, held.
Fit FitPoint(const Problem& problem, Point start, int most_steps = 8);

std::size_t ParameterCount(const Point& point);

}  // namespace contour::diagnosis
