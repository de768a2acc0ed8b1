#include "daemon/learning/smoothing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace contour {
namespace {

/// Weights beyond so many standard deviations are nothing in single precision's sense of a sum.
constexpr double kReach = 4.5;

}  // namespace

// A Gaussian of standard deviation s passes exp(-(2 pi f s)^2 / 2) of the amplitude at f.
Smoothing::Smoothing(double bandwidth_Hz, double period_s) {
  const double deviation = std::sqrt(std::numbers::ln2) / (2.0 * std::numbers::pi * bandwidth_Hz * period_s);
  const auto reach = static_cast<std::size_t>(std::ceil(kReach * deviation));
  std::vector<double> weights;
  double sum = 0.0;
  for (std::size_t j = 0; j <= reach; ++j) {
    const double x = static_cast<double>(j) / deviation;
    weights.push_back(std::exp(-0.5 * x * x));
    sum += (j == 0 ? 1.0 : 2.0) * weights.back();
  }
  for (const double w : weights) half_.push_back(static_cast<float>(w / sum));
}

std::vector<float> Smoothing::Of(const std::vector<float>& values) const {
  const std::size_t n = values.size();
  std::vector<float> out(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = half_[0] * values[i];
  for (std::size_t j = 1; j < std::min(half_.size(), n); ++j) {
    const float w = half_[j];
    for (std::size_t i = 0; i + j < n; ++i) {
      out[i] += w * values[i + j];
      out[i + j] += w * values[i];
    }
  }
  return out;
}

}  // namespace contour
