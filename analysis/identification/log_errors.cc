#include "analysis/identification/log_errors.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/identification/simulation.h"
#include "analysis/parallel/parallel_for.h"
#include "analysis/prediction_error/block_whitening.h"

namespace contour::identify {
namespace {

constexpr int kOrder = 12;
constexpr double kLeastError_m = 1e-12;
/// A wrong parameter makes many windows bad, as every chirp passes the mode: one in twenty tells how bad.
/// What is so many times worse than that comes alone.
constexpr double kShareAtMost = 0.95;
constexpr double kMostOverThose = 10.0;
constexpr Eigen::Index kFewestWindows = 20;  ///< fewer have no one in twenty
constexpr double kWindow_s = 0.1;            ///< the shortest stretch of shaken sliding

/// A simulated axis that sticks for a moment where the real one slides is off by hundreds of what it is off
/// by elsewhere. One such window would outweigh all that the parameters do: it counts as the most that a
/// window may be off.
Eigen::VectorXd WithoutSlips(Eigen::VectorXd errors_m, Eigen::Index window_rows) {
  const Eigen::Index windows = errors_m.size() / window_rows;
  if (windows < kFewestWindows) return errors_m;
  std::vector<double> rms_m;
  for (Eigen::Index w = 0; w < windows; ++w)
    rms_m.push_back(errors_m.segment(w * window_rows, window_rows).norm() /
                    std::sqrt(static_cast<double>(window_rows)));
  std::vector<double> sorted_m = rms_m;
  const auto at =
      sorted_m.begin() + static_cast<std::ptrdiff_t>(kShareAtMost * static_cast<double>(sorted_m.size() - 1));
  std::nth_element(sorted_m.begin(), at, sorted_m.end());
  const double most_m = kMostOverThose * std::max(*at, kLeastError_m);
  for (Eigen::Index w = 0; w < windows; ++w) {
    const double r = rms_m[static_cast<std::size_t>(w)];
    if (r > most_m) errors_m.segment(w * window_rows, window_rows) *= most_m / r;
  }
  return errors_m;
}

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
  const auto window_rows =
      static_cast<Eigen::Index>(std::max(1.0, std::round(kWindow_s / records.front().period_s)));
  std::vector<double> logs(axes.size(), 1e300);
  ParallelFor(axes.size(), threads, [&](std::size_t i) {
    const auto column = errors.col(static_cast<Eigen::Index>(i));
    if (!column.allFinite()) return;
    diagnosis::BlockWhitening whitening;
    whitening.Learn(WithoutSlips(column, window_rows), block, kOrder, kLeastError_m);
    logs[i] = whitening.log_error();
  });
  return logs;
}

}  // namespace contour::identify
