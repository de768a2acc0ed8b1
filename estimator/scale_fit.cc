#include "estimator/scale_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/turn.h"
#include "estimator/within_bounds.h"

namespace contour {
namespace {

// Leads of screws that are sold, warm ones included, are off by no more; over one turn by less.
constexpr double kLeadStd_rel = 1.5e-4;
constexpr double kTurnStd_rel = 1e-4;
// Beyond so many standard deviations nothing is believed.
constexpr double kBound = 4.0;
// Of a count: variance of what rounding takes away.
constexpr double kRounding = 1.0 / 12.0;
// Of a count in a period: an axis that is slower tells nothing.
constexpr double kLeastMove = 1e-6;
// What is not told apart by the others becomes the zero's, within a quarter of a second.
constexpr double kZeroRate_1_s = 4.0;
// Variance that a second of motion adds, as a share of the one at the start.
constexpr double kDrift_1_s = 3e-3;

}  // namespace

ScaleFit::ScaleFit(const Setup& setup) noexcept : setup_(setup) {
  prior_ = {std::hypot(setup.noise_m, std::sqrt(kRounding) * setup.count_m),
            setup.compliance_std,
            kLeadStd_rel,
            kTurnStd_rel * setup.turn_m,
            kTurnStd_rel * setup.turn_m,
            setup.mass_std_s2};
  zero_share_ = 1.0 - std::exp(-kZeroRate_1_s * setup.period_s);
  const double zero_m = setup.noise_m * kZeroRate_1_s * setup.period_s;
  zero_drift_m2_ = zero_m * zero_m;
  for (std::size_t i = kCompliance; i < kSize; ++i)
    drift_[i] = kDrift_1_s * setup.period_s * prior_[i] * prior_[i];
  bound_[kZero] = std::numeric_limits<double>::infinity();
  for (std::size_t i = kCompliance; i < kSize; ++i) bound_[i] = kBound * prior_[i];
  Reset(0.0);
}

void ScaleFit::Reset(double apart_m) noexcept {
  value_ = {};
  value_[kZero] = apart_m;
  covariance_ = {};
  for (std::size_t i = 0; i < kSize; ++i) covariance_[i][i] = prior_[i] * prior_[i];
}

void ScaleFit::LetGo(double apart_m) noexcept {
  const double mass = value_[kMass], variance = covariance_[kMass][kMass];
  Reset(apart_m);
  value_[kMass] = mass;
  covariance_[kMass][kMass] = variance;
}

// All readings within one count are rounded by one error: together they tell as much as one. As variance of
// each of them, at rest without end.
double ScaleFit::Rounding_m2(double velocity_m_s) const noexcept {
  if (!(setup_.count_m > 0.0)) return 0.0;
  const double moved_m = std::max(std::abs(velocity_m_s) * setup_.period_s, kLeastMove * setup_.count_m);
  return kRounding * setup_.count_m * setup_.count_m * std::max(1.0, setup_.count_m / moved_m);
}

// What a bound keeps from its value, the others must not keep from theirs: a zero that moves one way while
// the lead that it was to make up for stays where it is explains the next sample worse, and the one after
// worse still.
void ScaleFit::Bound() noexcept {
  bool within = true;
  for (std::size_t i = 0; i < kSize; ++i) within = within && std::abs(value_[i]) <= bound_[i];
  if (!within) WithinBounds<kSize>(covariance_, bound_).Move(value_);
}

void ScaleFit::Learn(const Sample& s) noexcept {
  const Row h{1.0, s.force_N, s.travel_m, s.cos, s.sin, s.acceleration_m_s2};
  double expected_m = 0.0;
  for (std::size_t i = 0; i < kSize; ++i) expected_m += value_[i] * h[i];
  const double error_m = s.apart_m - expected_m;
  if (!setup_.learns || !s.moves) {
    // A standing axis tells of the zero alone. Half a count is what this reading is rounded by, another half
    // what those that the zero is from were.
    value_[kZero] += zero_share_ * (error_m - std::clamp(error_m, -setup_.count_m, setup_.count_m));
    return;
  }
  Row along{};
  // In corners more is off than a mass: torque that comes late, a screw that swings.
  const double inertial_m = setup_.mass_std_s2 * s.acceleration_m_s2;
  double variance = setup_.noise_m * setup_.noise_m + inertial_m * inertial_m + Rounding_m2(s.velocity_m_s);
  covariance_[kZero][kZero] += zero_drift_m2_;
  for (std::size_t i = 0; i < kSize; ++i) {
    // What nothing excites does not become less known than it was at the start.
    if (i != kZero && covariance_[i][i] < prior_[i] * prior_[i]) covariance_[i][i] += drift_[i];
    for (std::size_t j = 0; j < kSize; ++j) along[i] += covariance_[i][j] * h[j];
    variance += along[i] * h[i];
  }
  for (std::size_t i = 0; i < kSize; ++i) value_[i] += along[i] / variance * error_m;
  // Each factor on its own, so that rounding keeps it symmetric.
  const double root = 1.0 / std::sqrt(variance);
  for (double& a : along) a *= root;
  for (std::size_t i = 0; i < kSize; ++i)
    for (std::size_t j = 0; j < kSize; ++j) covariance_[i][j] -= along[i] * along[j];
  Bound();
}

double ScaleFit::Lead_m(double travel_m, double position_m) const noexcept {
  const CosSin angle = Turn(position_m / setup_.turn_m);
  return value_[kSlope] * travel_m + value_[kCos] * angle.cos + value_[kSin] * angle.sin;
}

}  // namespace contour
