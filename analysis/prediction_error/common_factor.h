#pragma once

#include <Eigen/Core>

#include "analysis/prediction_error/problem.h"

namespace contour::diagnosis {

/// A torque constant that is off by exp(x) looks like all forces off by exp(-x): only the priors tell. The x
/// that they like best, and what they gain by it. What the fit has made of the constant itself, within what
/// is stated of it, is part of it.
struct CommonFactor {
  double log_ratio = 0.0, drop = 0.0, sigma = 0.0;
};
CommonFactor FindCommonFactor(const Problem& problem, const Point& point);
/// The same motion with that factor in place of what the stated torque constant was moved by.
void TakeOver(const Problem& problem, double log_ratio, Point& point);

/// Puts into the columns of torque constants what the others say of them: the residual is the same when all
/// forces and the torque constant change by one factor. Differences of runs are not as exact, and what
/// they leave in that direction outweighs the priors, which alone decide there.
/// `jacobian`: of base terms, then amplitudes. Nothing is done where the stated model has forces of its own,
/// which do not change with the others.
void MakeConsistent(const Problem& problem, const Point& point, Eigen::MatrixXd& jacobian);

}  // namespace contour::diagnosis
