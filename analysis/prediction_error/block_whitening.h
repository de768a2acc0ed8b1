#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace contour::diagnosis {

/// Makes prediction errors alike: each block of time is divided by its own level, then an autoregressive
/// filter takes out what one error says of the next. Whitener is for noise that keeps its level; this is for
/// records whose strokes are of different speeds.
class BlockWhitening {
 public:
  /// From errors (0: no value). `order` 0: levels only. No block counts as quieter than `floor`.
  void Learn(const Eigen::VectorXd& errors, std::size_t block, int order, double floor);
  [[nodiscard]] Eigen::VectorXd Apply(const Eigen::VectorXd& errors) const;
  /// Of the errors learnt from: mean log of what the filter leaves, in their own unit.
  [[nodiscard]] double log_error() const { return log_error_; }

 private:
  std::size_t block_ = 1;
  std::vector<double> weight_;  ///< per block
  std::vector<double> taps_;    ///< of the level's error filter; empty: none
  double scale_ = 1.0;
  double log_error_ = 0.0;
};

}  // namespace contour::diagnosis
