#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/prediction_error/problem.h"
#include "analysis/prediction_error/scale_noise.h"

// The channel of the scale: what it reads beyond the encoder, and its noise.
namespace contour::diagnosis {

void Problem::AddScale(const std::vector<double>& table, bool two, const double* error,
                       const double* measured, std::vector<double>& raw, Extent extent) const {
  const std::size_t n = table.size();
  // The correction goes only part of the distance to the encoder's reading.
  const double rest = 1.0 - (two ? setup.gain_two : setup.gain)[0];
  raw.resize(2 * n);
  const auto row = [&](std::size_t i) { return extent == Extent::kWhole ? i : excerpt.row[i]; };
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = row(i);
    const double e = (measured != nullptr ? measured[k] : 0.0) -
                     stated.table_per_q * (table[i] + rest * raw[i]) - (error != nullptr ? error[k] : 0.0);
    raw[n + i] = e;
    if (ScaleCounts(k)) {
      sum += e;
      count += 1.0;
    }
  }
  const double mean = sum / std::max(1.0, count);
  for (std::size_t i = 0; i < n; ++i) raw[n + i] = ScaleCounts(row(i)) ? raw[n + i] - mean : 0.0;
}

void Problem::LearnScaleNoise(std::vector<double>& raw) {
  const std::size_t n = rows();
  const std::vector<double> shapeless = WithoutShape(std::span(raw).subspan(n), counted, *signals);
  std::copy(shapeless.begin(), shapeless.end(), raw.begin() + static_cast<std::ptrdiff_t>(n));
  scale_noise = Whitener(std::span(raw).subspan(n), counted);
  scale_wander = {};
  const std::vector<double> white = White(std::span(&raw, 1))[0];
  LowerWhereScaleRests(&root_weight[n]);
  for (std::size_t k = 0; k < n; ++k)
    if (!ScaleCounts(k)) root_weight[n + k] = 0.0;
  scale_wander =
      LearnSlowWander(std::span(white).subspan(n), std::span(root_weight).subspan(n), signals->begins);
}

void Problem::LowerWhereScaleRests(double* w) const {
  // Within one count of the scale its rounding error is the same from row to row: no more is known than after
  // the first.
  const double step = CountOf(log.table_position_m);
  if (!std::isfinite(step)) return;
  for (std::size_t k = 0; k < rows(); ++k) {
    const double counts_per_row = std::fabs(signals->velocity[k]) * log.period_s * stated.table_per_q / step;
    w[k] *= std::sqrt(std::clamp(counts_per_row, kRows.least_counts_per_row, 1.0));
  }
}

}  // namespace contour::diagnosis
