#include "analysis/identification/bristle_start.h"

#include <algorithm>

#include "analysis/identification/log_errors.h"

namespace contour::identify {
namespace {

/// The first as it is.
constexpr double kFactors[] = {1.0, 0.25, 0.35, 0.5, 0.7, 1.4, 2.0};
/// Long against the bristle's own motion, short against a stroke.
constexpr double kBlock_s = 1.0;

}  // namespace

double BristleToBeginWith_N_m(const TableAxis& axis, const std::vector<Measured>& records,
                              const std::vector<double>& others_N_m, int threads) {
  std::vector<TableAxis> tried;
  for (const double factor : kFactors) {
    tried.push_back(axis);
    tried.back().friction.s0 *= factor;
  }
  for (const double other_N_m : others_N_m) {
    tried.push_back(axis);
    tried.back().friction.s0 = other_N_m;
  }
  const std::vector<double> errors = LogErrors(tried, records, kBlock_s, threads);
  const auto best = std::min_element(errors.begin(), errors.end()) - errors.begin();
  return tried[static_cast<std::size_t>(best)].friction.s0;
}

}  // namespace contour::identify
