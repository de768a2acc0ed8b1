#pragma once

#include <cmath>
#include <vector>

namespace contour::diagnosis::test {

inline double Distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum);
}

}  // namespace contour::diagnosis::test
