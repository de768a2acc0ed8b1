#include "analysis/identification/log_errors.h"

#include <algorithm>

#include "analysis/identification/simulation.h"
#include "analysis/parallel/parallel_for.h"
#include "analysis/prediction_error/block_whitening.h"

namespace contour::identify {
namespace {

constexpr int kOrder = 12;
constexpr double kLeastError_m = 1e-12;

}  // namespace

std::vector<double> LogErrors(const std::vector<TableAxis>& axes, const std::vector<Measured>& records,
                              double block_s, int threads) {
  std::vector<Followed> followed;
  followed.reserve(axes.size());
  for (const TableAxis& axis : axes) followed.push_back({axis, FollowGainFor(axis, records.front())});
  const Eigen::MatrixXd errors = PredictionErrors_m(followed, records, threads);
  const double rows = static_cast<double>(errors.rows());
  const auto block =
      static_cast<std::size_t>(std::clamp(block_s / records.front().period_s, 1.0, std::max(1.0, rows)));
  std::vector<double> logs(axes.size(), 1e300);
  ParallelFor(axes.size(), threads, [&](std::size_t i) {
    const auto column = errors.col(static_cast<Eigen::Index>(i));
    if (!column.allFinite()) return;
    diagnosis::BlockWhitening whitening;
    whitening.Learn(column, block, kOrder, kLeastError_m);
    logs[i] = whitening.log_error();
  });
  return logs;
}

}  // namespace contour::identify
