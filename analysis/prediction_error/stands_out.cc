#include "analysis/prediction_error/stands_out.h"

#include <algorithm>
#include <cmath>

#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/diagnosis/tuning/statistics.h"

namespace contour::diagnosis {
namespace {

double MedianDeviation(std::vector<double>& magnitudes) {
  if (magnitudes.empty()) return 0.0;
  const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
  std::nth_element(magnitudes.begin(), middle, magnitudes.end());
  return kNormalMad * *middle;
}

}  // namespace

StandsOut::StandsOut(const std::vector<double>& values, double position_step)
    : values_(values), counts_(kRows.outlier_counts * position_step) {
  for (const double v : values)
    if (std::isfinite(v)) scratch_.push_back(std::fabs(v));
  level_ = MedianDeviation(scratch_);
}

double StandsOut::LevelNear(std::size_t row) {
  const std::size_t half = kRows.outlier_reach_rows;
  scratch_.clear();
  for (std::size_t i = row > half ? row - half : 0; i < std::min(values_.size(), row + half); i += 2)
    if (std::isfinite(values_[i])) scratch_.push_back(std::fabs(values_[i]));
  return MedianDeviation(scratch_);
}

bool StandsOut::operator()(std::size_t row) {
  // Of a log that rests most of the time, with counts that nobody stated: there is nothing to stand out from.
  if (!(level_ > 0.0) && !(counts_ > 0.0)) return false;
  const double e = std::fabs(values_[row]);
  // The neighbourhood is looked at only where the row stands out from the whole log.
  return e >= kRows.outlier_deviations * level_ + counts_ &&
         e >= kRows.outlier_near_deviations * LevelNear(row) + counts_;
}

}  // namespace contour::diagnosis
