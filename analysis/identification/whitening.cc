#include "analysis/identification/whitening.h"

#include <algorithm>
#include <cmath>

namespace contour::identify {

void Whitening::Learn(const Eigen::VectorXd& errors, std::size_t block, int order, double floor) {
  block_ = block;
  weight_.clear();
  filter_.clear();
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
  // Yule and Walker, solved by Levinson and Durbin.
  std::vector<double> c(static_cast<std::size_t>(order) + 1, 0.0);
  for (std::size_t lag = 0; lag < c.size(); ++lag) {
    const auto shift = static_cast<Eigen::Index>(lag);
    c[lag] = level.head(level.size() - shift).dot(level.tail(level.size() - shift));
  }
  if (!(c[0] > 0.0)) return;
  c[0] *= 1.0 + 1e-9;
  std::vector<double> a;
  double left = c[0];
  for (std::size_t m = 1; m < c.size(); ++m) {
    double sum = c[m];
    for (std::size_t i = 0; i < a.size(); ++i) sum -= a[i] * c[m - 1 - i];
    const double reflection = sum / left;
    std::vector<double> next = a;
    next.push_back(reflection);
    for (std::size_t i = 0; i < a.size(); ++i) next[i] -= reflection * a[a.size() - 1 - i];
    a = std::move(next);
    left *= 1.0 - reflection * reflection;
  }
  filter_ = std::move(a);
  scale_ = 1.0 / std::sqrt(std::max(left / static_cast<double>(n), 1e-30));
  log_error_ -= std::log(scale_);
}

Eigen::VectorXd Whitening::Apply(const Eigen::VectorXd& errors) const {
  Eigen::VectorXd level(errors.size());
  for (Eigen::Index i = 0; i < errors.size(); ++i)
    level(i) = errors(i) * weight_[static_cast<std::size_t>(i) / block_];
  if (filter_.empty()) return level;
  Eigen::VectorXd out(errors.size());
  const auto order = static_cast<Eigen::Index>(filter_.size());
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    double predicted = 0.0;
    for (Eigen::Index j = 0; j < std::min(order, i); ++j)
      predicted += filter_[static_cast<std::size_t>(j)] * level(i - 1 - j);
    out(i) = scale_ * (level(i) - predicted);
  }
  return out;
}

}  // namespace contour::identify
