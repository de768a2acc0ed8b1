#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace contour::diagnosis {

/// a' b, columns given by where they begin.
Eigen::MatrixXd ProductsOf(std::span<const double* const> a, std::span<const double* const> b,
                           std::size_t size);
/// Columns from `from` on of j' j, and their mirror images.
void AddProducts(const Eigen::MatrixXd& j, Eigen::Index from, Eigen::MatrixXd& normal);
/// j' r.
Eigen::VectorXd GradientOf(const Eigen::MatrixXd& j, const std::vector<double>& r);

std::vector<const double*> ColumnsOf(const Eigen::MatrixXd& j);

}  // namespace contour::diagnosis
