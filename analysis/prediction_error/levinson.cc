#include "analysis/prediction_error/levinson.h"

#include <cstddef>

namespace contour::diagnosis {

ErrorFilter MakeErrorFilter(std::span<const double> autocovariance) {
  const std::size_t order = autocovariance.size() - 1;
  ErrorFilter filter{std::vector<double>(order + 1, 0.0), autocovariance[0] * (1.0 + 1e-9)};
  std::vector<double>& a = filter.taps;
  a[0] = 1.0;
  for (std::size_t m = 1; m <= order; ++m) {
    double sum = autocovariance[m];
    for (std::size_t i = 1; i < m; ++i) sum += a[i] * autocovariance[m - i];
    const double reflection = -sum / filter.left;
    const std::vector<double> before = a;
    for (std::size_t i = 1; i < m; ++i) a[i] = before[i] + reflection * before[m - i];
    a[m] = reflection;
    filter.left *= 1.0 - reflection * reflection;
  }
  return filter;
}

}  // namespace contour::diagnosis
