#include "analysis/prediction_error/block_whitening.h"

#include <algorithm>
#include <cmath>

#include "analysis/prediction_error/levinson.h"

namespace contour::diagnosis {

void BlockWhitening::Learn(const Eigen::VectorXd& errors, std::size_t block, int order, double floor) {
  block_ = block;
  weight_.clear();
  taps_.clear();
  scale_ = 1.0;
  log_error_ = 0.0;
  const auto n = static_cast<std::size_t>(errors.size());
  for (std::size_t b = 0; b < n; b += block) {
    const auto length = static_cast<Eigen::Index>(std::min(block, n - b));
    const auto part = errors.segment(static_cast<Eigen::Index>(b), length);
    const double rms = std::sqrt(part.squaredNorm() / static_cast<double>(length));
    weight_.push_back(1.0 / std::max(rms, floor));
    log_error_ -= std::log(weight_.back()) * static_cast<double>(length) / static_cast<double>(n);
  }
  if (order <= 0) return;
  const Eigen::VectorXd level = Apply(errors);
  std::vector<double> c(static_cast<std::size_t>(order) + 1, 0.0);
  for (std::size_t lag = 0; lag < c.size(); ++lag) {
    const auto shift = static_cast<Eigen::Index>(lag);
    c[lag] = level.head(level.size() - shift).dot(level.tail(level.size() - shift));
  }
  if (!(c[0] > 0.0)) return;
  ErrorFilter filter = MakeErrorFilter(c);
  taps_ = std::move(filter.taps);
  scale_ = 1.0 / std::sqrt(std::max(filter.left / static_cast<double>(n), 1e-30));
  log_error_ -= std::log(scale_);
}

Eigen::VectorXd BlockWhitening::Apply(const Eigen::VectorXd& errors) const {
  Eigen::VectorXd level(errors.size());
  for (Eigen::Index i = 0; i < errors.size(); ++i)
    level(i) = errors(i) * weight_[static_cast<std::size_t>(i) / block_];
  if (taps_.empty()) return level;
  Eigen::VectorXd out(errors.size());
  const auto order = static_cast<Eigen::Index>(taps_.size()) - 1;
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    double left = level(i);
    for (Eigen::Index j = 1; j <= std::min(order, i); ++j)
      left += taps_[static_cast<std::size_t>(j)] * level(i - j);
    out(i) = scale_ * left;
  }
  return out;
}

}  // namespace contour::diagnosis
