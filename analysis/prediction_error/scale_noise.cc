#include "analysis/prediction_error/scale_noise.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/diagnosis/tuning/prediction_tuning.h"

namespace contour::diagnosis {
namespace {

constexpr Eigen::Index kCosines = kNoise.scale_cosines;

}  // namespace

std::vector<double> WithoutShape(std::span<const double> residual, const std::vector<std::uint8_t>& counted,
                                 const Signals& signals) {
  using Terms = Eigen::Matrix<double, kCosines + 1, 1>;
  const double half = std::max(signals.half_stroke_m, 1e-9);
  const auto terms_at = [&](std::size_t k) {
    // cos(j x) = 2 cos x cos((j - 1) x) - cos((j - 2) x).
    const double u = std::clamp(signals.table_m[k] / half, -1.0, 1.0);
    const double c = std::cos(0.5 * std::numbers::pi * (u + 1.0));
    Terms t;
    t(0) = 1.0;
    t(1) = c;
    for (Eigen::Index j = 2; j <= kCosines; ++j) t(j) = 2.0 * c * t(j - 1) - t(j - 2);
    return t;
  };
  Eigen::Matrix<double, kCosines + 1, kCosines + 1> normal;
  Terms gradient = Terms::Zero();
  normal.setZero();
  for (std::size_t k = 0; k < residual.size(); ++k) {
    if (counted[k] == 0) continue;
    const Terms t = terms_at(k);
    normal += t * t.transpose();
    gradient += residual[k] * t;
  }
  // A stroke so short that the cosines are alike has no shape.
  normal.diagonal().array() += 1e-6 * normal(0, 0) + 1e-300;
  const Terms shape = normal.ldlt().solve(gradient);
  std::vector<double> out(residual.begin(), residual.end());
  for (std::size_t k = 0; k < out.size(); ++k)
    if (counted[k] != 0) out[k] -= shape.dot(terms_at(k));
  return out;
}

double CountOf(std::span<const double> readings_m) {
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < readings_m.size(); ++k) {
    const double d = std::fabs(readings_m[k] - readings_m[k - 1]);
    if (d > 1e-12) step = std::min(step, d);
  }
  return step;
}

}  // namespace contour::diagnosis
