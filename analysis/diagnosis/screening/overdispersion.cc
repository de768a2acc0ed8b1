#include "analysis/diagnosis/screening/overdispersion.h"

#include <algorithm>
#include <cmath>

namespace contour::diagnosis {

double WithinBlocks(const Eigen::MatrixXd& per_block, const Eigen::MatrixXd& covariance) {
  const double by_chance = (covariance * (per_block * per_block.transpose())).trace();
  return std::max(1.0, by_chance / static_cast<double>(per_block.rows()));
}

double Overdispersion(const Eigen::MatrixXd& per_block, const Eigen::MatrixXd& covariance) {
  const Eigen::Index blocks = per_block.cols();
  const auto reach = static_cast<Eigen::Index>(std::sqrt(static_cast<double>(blocks)));
  Eigen::MatrixXd variance = per_block * per_block.transpose();
  for (Eigen::Index lag = 1; lag <= reach && lag < blocks; ++lag) {
    const double share = 1.0 - static_cast<double>(lag) / static_cast<double>(reach + 1);
    const Eigen::MatrixXd shifted =
        per_block.leftCols(blocks - lag) * per_block.rightCols(blocks - lag).transpose();
    variance += share * (shifted + shifted.transpose());
  }
  return std::max(WithinBlocks(per_block, covariance),
                  (covariance * variance).trace() / static_cast<double>(per_block.rows()));
}

}  // namespace contour::diagnosis
