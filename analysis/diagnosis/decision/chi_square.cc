#include "analysis/diagnosis/decision/chi_square.h"

#include <cmath>
#include <numbers>
#include <unsupported/Eigen/SpecialFunctions>

namespace contour::diagnosis {
namespace {

/// Where a falling function of x >= 0 crosses a probability.
template <class F>
double Crossing(F&& exceeds, double probability, double high) {
  while (exceeds(high) > probability) high *= 2.0;
  double low = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double x = 0.5 * (low + high);
    (exceeds(x) > probability ? low : high) = x;
  }
  return low;
}

}  // namespace

double ChiSquareQuantile(std::size_t degrees, double probability) {
  // The square of a normal deviate, and an exponential distribution, have simpler forms.
  if (degrees == 1) {
    const double z = Crossing([](double x) { return std::erfc(x / std::numbers::sqrt2); }, probability, 10.0);
    return z * z;
  }
  if (degrees == 2) return -2.0 * std::log(probability);
  const double half = 0.5 * static_cast<double>(degrees);
  return Crossing([&](double x) { return Eigen::numext::igammac(half, 0.5 * x); }, probability, 10.0);
}

}  // namespace contour::diagnosis
