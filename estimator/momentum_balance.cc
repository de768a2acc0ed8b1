#include "estimator/momentum_balance.h"

#include <algorithm>

#include "estimator/share_of_period.h"

namespace contour {
namespace {

// Shares per millisecond.
constexpr double kLow = 0.1;         // low-pass of both: 10 ms
constexpr double kSlowHigh = 0.005;  // high-pass for the mass: 200 ms
constexpr double kFastHigh = 0.06;   // and for the delay: 16 ms
// Evidence that the commissioned delay weighs as much as, (N/ms)^2 ms.
constexpr double kDelayPrior = 2e3;
constexpr double kMost = 0.4;

}  // namespace

MomentumBalance::MomentumBalance(const Tuning& tuning) noexcept
    : tuning_(tuning),
      shares_{ShareOfPeriod(kLow, tuning.period_s), ShareOfPeriod(kSlowHigh, tuning.period_s),
              ShareOfPeriod(kFastHigh, tuning.period_s)},
      period_ms_(tuning.period_s / 1e-3) {}

MomentumBalance::Bands MomentumBalance::Filter::Step(double value, const Shares& shares) noexcept {
  low += shares.low * (value - low);
  slow_mean += shares.slow * (low - slow_mean);
  fast_mean += shares.fast * (low - fast_mean);
  const double s = low - slow_mean, q = low - fast_mean;
  const Bands out{0.5 * (s + slow), s - slow, 0.5 * (q + fast), q - fast};
  slow = s;
  fast = q;
  return out;
}

void MomentumBalance::Learn(double position_m, double force_N, double friction_N) noexcept {
  const double velocity_m_s = (position_m - position_m_) / tuning_.period_s;
  const double acceleration_m_s2 = (velocity_m_s - velocity_m_s_) / tuning_.period_s;
  const double driving_N = force_N - friction_N;
  // The second difference belongs to the middle of two periods.
  const double both_N = 0.5 * (driving_N + driving_N_);
  const double mass_kg = tuning_.mass_kg + extra_kg_;
  missing_ = {mass_kg * acceleration_m_s2 - both_N, position_m_, 0.5 * (velocity_m_s + velocity_m_s_),
              acceleration_m_s2, true};
  position_m_ = position_m;
  velocity_m_s_ = velocity_m_s;
  driving_N_ = driving_N;
  if (known_periods_ < 3) {
    ++known_periods_;
    acceleration_ = {};
    balance_ = {};
    missing_.known = false;
    return;
  }
  if (!(tuning_.mass_rate > 0.0 || tuning_.delay_rate > 0.0)) return;
  const Bands a = acceleration_.Step(acceleration_m_s2, shares_);
  const Bands f = balance_.Step(both_N, shares_);
  LearnMass(a.slow, a.slow_change, f.slow, mass_kg);
  LearnDelay(a.fast, a.fast_change, f.fast, mass_kg);
}

void MomentumBalance::LearnMass(double acceleration_m_s2, double change_m_s2, double force_N,
                                double mass_kg) noexcept {
  if (!(tuning_.mass_rate > 0.0)) return;
  const double late_m_s2 = acceleration_m_s2 + delay_periods_ * change_m_s2;
  const double seen = period_ms_ * late_m_s2;
  mass_seen_ = std::min(mass_seen_ + seen * late_m_s2, 1.0 / tuning_.mass_rate);
  const double most_kg = kMost * tuning_.mass_kg;
  extra_kg_ = std::clamp(extra_kg_ + seen * (force_N - mass_kg * late_m_s2) / (mass_seen_ + kMassPrior),
                         -most_kg, most_kg);
}

void MomentumBalance::LearnDelay(double acceleration_m_s2, double change_m_s2, double force_N,
                                 double mass_kg) noexcept {
  if (!(tuning_.delay_rate > 0.0)) return;
  const double change_N = mass_kg * change_m_s2;
  // Periods times change per period are milliseconds times change per millisecond.
  delay_seen_ = std::min(delay_seen_ + change_N * change_N / period_ms_, 1e4 / tuning_.delay_rate);
  const double error_N = force_N - mass_kg * (acceleration_m_s2 + delay_periods_ * change_m_s2);
  const double more = change_N * error_N / (delay_seen_ + kDelayPrior) / period_ms_;
  delay_periods_ = std::clamp(delay_periods_ + more, 0.0, 1.0);
}

}  // namespace contour
