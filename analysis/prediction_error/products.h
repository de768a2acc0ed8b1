#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace contour::diagnosis {

/// a' b, columns given by where they begin.
Eigen::MatrixXd ProductsOf(std::span<const double* const> a, std::span<const double* const> b,
                           std::size_t size);
/// a' b, and b' r in blocks of time. Columns are one or more runs of `rows` rows, back to back.
struct ProductsInBlocks {
  Eigen::MatrixXd products;  ///< a x b
  Eigen::MatrixXd with_r;    ///< b x blocks
};
ProductsInBlocks MakeProductsInBlocks(std::span<const double* const> a, std::span<const double* const> b,
                                      const double* r, std::size_t rows, std::size_t size,
                                      std::size_t blocks);
/// Columns from `from` on of j' j, and their mirror images.
void AddProducts(const Eigen::MatrixXd& j, Eigen::Index from, Eigen::MatrixXd& normal);
/// j' r.
Eigen::VectorXd GradientOf(const Eigen::MatrixXd& j, const std::vector<double>& r);

std::vector<const double*> ColumnsOf(const Eigen::MatrixXd& j);

}  // namespace contour::diagnosis
