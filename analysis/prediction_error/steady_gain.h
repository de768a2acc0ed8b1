#pragma once

#include <Eigen/Core>

namespace contour::diagnosis {

/// The gain at which the Kalman filter of x+ = f x + w, read as the first element of x, comes to rest.
/// `noise` is the covariance of w, `reading` the variance of a reading, `start` the covariance of x that the
/// iteration begins from.
Eigen::VectorXd SteadyGain(const Eigen::MatrixXd& f, const Eigen::MatrixXd& noise, double reading,
                           const Eigen::MatrixXd& start);

}  // namespace contour::diagnosis
