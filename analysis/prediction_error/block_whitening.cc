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
  const auto length = static_cast<Eigen::Index>(block_);
  for (std::size_t b = 0; b < weight_.size(); ++b) {
    const Eigen::Index from = static_cast<Eigen::Index>(b) * length;
    const Eigen::Index rows = std::min(length, errors.size() - from);
    level.segment(from, rows) = errors.segment(from, rows) * weight_[b];
  }
  if (taps_.empty()) return level;
  // Many rows at a time, which the vectors of the machine then take side by side.
  constexpr Eigen::Index kRows = 1024;
  Eigen::VectorXd out(errors.size());
  const auto order = static_cast<Eigen::Index>(taps_.size()) - 1;
  for (Eigen::Index from = 0; from < errors.size(); from += kRows) {
    const Eigen::Index rows = std::min(kRows, errors.size() - from);
    auto left = out.segment(from, rows);
    left = level.segment(from, rows);
    for (Eigen::Index j = 1; j <= order; ++j) {
      const Eigen::Index first = std::max(from, j);
      if (first < from + rows)
        out.segment(first, from + rows - first) +=
            taps_[static_cast<std::size_t>(j)] * level.segment(first - j, from + rows - first);
    }
    left *= scale_;
  }
  return out;
}

}  // namespace contour::diagnosis
