#include "daemon/program/rest_map.h"

#include <algorithm>

#include "daemon/program/bisection.h"

namespace contour {
namespace {

/// x^3 - x^4 / 2: slope 1 and no curvature at x = 1.
double Rise(double x) { return x * x * x * (1.0 - 0.5 * x); }

double InverseRise(double rise) {
  return LargestThat([&](double x) { return Rise(x) <= rise; }, 0.0, 1.0);
}

}  // namespace

RestMap::RestMap(double from_m, double to_m, double begin_m, double end_m) : from_m_(from_m), to_m_(to_m) {
  const double length = to_m - from_m;
  const double both = 0.5 * (begin_m + end_m);
  const double share = both > length ? length / both : 1.0;
  begin_ = share * begin_m;
  end_ = share * end_m;
  end_u_ = std::max(begin_ + end_, length + 0.5 * (begin_ + end_));
}

RestMap::Derivatives RestMap::At(double u) const { return At(u, u); }

RestMap::Derivatives RestMap::At(double u, double within) const {
  if (within < begin_) {
    const double x = std::max(0.0, u / begin_);
    return {from_m_ + begin_ * Rise(x), x * x * (3.0 - 2.0 * x), 6.0 * x * (1.0 - x) / begin_,
            (6.0 - 12.0 * x) / (begin_ * begin_)};
  }
  if (within > end_u_ - end_) {
    const double x = std::max(0.0, (end_u_ - u) / end_);
    return {to_m_ - end_ * Rise(x), x * x * (3.0 - 2.0 * x), -6.0 * x * (1.0 - x) / end_,
            (6.0 - 12.0 * x) / (end_ * end_)};
  }
  return {from_m_ + u - 0.5 * begin_, 1.0, 0.0, 0.0};
}

double RestMap::Inverse(double way_m) const {
  const double since = way_m - from_m_, left = to_m_ - way_m;
  if (since < 0.5 * begin_) return begin_ * InverseRise(std::max(0.0, since) / begin_);
  if (left < 0.5 * end_) return end_u_ - end_ * InverseRise(std::max(0.0, left) / end_);
  return since + 0.5 * begin_;
}

}  // namespace contour
