#include "estimator/angle_force_map.h"

#include <algorithm>
#include <cmath>

#include "estimator/share_of_period.h"

namespace contour {
namespace {

// What may be expected of a motor, and what is never believed of one, in levels of the axis's friction;
// encoder noise above the first takes more visits to learn.
constexpr double kExpected = 0.125;
constexpr double kLargest = 1.25;
// The first visit counts as much as so many that found nothing. A visit is a millisecond.
constexpr double kCaution = 2.0;
// Of the mean and of the mean squares, per millisecond.
constexpr double kMeanShare = 0.02;
constexpr double kPowerShare = 0.005;
// Used from this share of the missing force's mean square on that it explains, and whole from the second.
constexpr double kExplainsLittle = 0.3;
constexpr double kExplainsMuch = 0.6;
// And only when it explains more than the ripple of the friction over a turn does, which is no force of the
// motor: levels, rms.
constexpr double kRipple = 0.0975;
// And only once the axis has been at so many of the places of a turn: on a short way to and fro, corners and
// friction come again at the same angle, too.
constexpr double kLeastOfTurn = 0.5;
// Slower, in Stribeck velocities, the friction filter follows by itself, and the ripple of the friction is in
// the way.
constexpr double kSlow = 2.0;
// Faster, in places per period, a cycle is too long to follow the teeth; from half of it on the map fades.
constexpr double kFast_places = 3.84;
// Where the axis needs more force to accelerate, in levels, what is missing is mostly mass.
constexpr double kQuiet = 2.25;

}  // namespace

AngleForceMap::AngleForceMap(const Tuning& tuning) noexcept
    : per_turn_1_m_(1.0 / tuning.lead_m),
      largest_N_(kLargest * tuning.level_N),
      ripple_N2_(kRipple * kRipple * tuning.level_N * tuning.level_N),
      slow_m_s_(kSlow * tuning.vs_m_s),
      fast_m_s_(kFast_places * tuning.lead_m / (static_cast<double>(kBins) * tuning.period_s)),
      quiet_m_s2_(kQuiet * tuning.level_N / tuning.mass_kg),
      first_visits_(kCaution + tuning.period_s / 1e-3 * tuning.noise_N * tuning.noise_N /
                                   (kExpected * kExpected * tuning.level_N * tuning.level_N)),
      rate_(tuning.rate),
      visit_(tuning.period_s / 1e-3),
      mean_share_(ShareOfPeriod(kMeanShare, tuning.period_s)),
      power_share_(ShareOfPeriod(kPowerShare, tuning.period_s)) {}

void AngleForceMap::Reset() noexcept {
  force_N_ = visits_ = {};
  places_ = 0;
  mean_N_ = without_N2_ = with_N2_ = use_ = 0.0;
}

AngleForceMap::Place AngleForceMap::PlaceOf(double position_m) const noexcept {
  const double turns = position_m * per_turn_1_m_;
  const double at = (turns - std::floor(turns)) * static_cast<double>(kBins);
  const auto bin = std::min(static_cast<std::size_t>(at), kBins - 1);
  return {bin, (bin + 1) % kBins, at - static_cast<double>(bin)};
}

double AngleForceMap::Stored_N(const Place& p) const noexcept {
  return (1.0 - p.share) * force_N_[p.bin] + p.share * force_N_[p.next];
}

double AngleForceMap::At_N(double position_m, double velocity_m_s) const noexcept {
  if (!(use_ > 0.0)) return 0.0;
  const double slow = std::clamp((fast_m_s_ - std::abs(velocity_m_s)) / (0.5 * fast_m_s_), 0.0, 1.0);
  return use_ * slow * Stored_N(PlaceOf(position_m));
}

void AngleForceMap::Learn(double position_m, double velocity_m_s, double acceleration_m_s2,
                          double missing_N) noexcept {
  const double speed_m_s = std::abs(velocity_m_s);
  if (!(rate_ > 0.0) || !(speed_m_s > slow_m_s_ && speed_m_s < 0.5 * fast_m_s_)) return;
  if (std::abs(acceleration_m_s2) > quiet_m_s2_) return;
  // What does not change with the angle is friction's or a cutting force.
  const Place p = PlaceOf(position_m);
  const double stored_N = Stored_N(p);
  const double whole_N = missing_N + use_ * stored_N;
  mean_N_ += mean_share_ * (whole_N - mean_N_);
  const double wanted_N = std::clamp(whole_N - mean_N_, -largest_N_, largest_N_);
  const double error_N = wanted_N - stored_N;
  without_N2_ += power_share_ * (wanted_N * wanted_N - without_N2_);
  with_N2_ += power_share_ * (error_N * error_N - with_N2_);
  const double explained = without_N2_ > 0.0 ? 1.0 - with_N2_ / without_N2_ : 0.0;
  const double matters = (without_N2_ - with_N2_ - ripple_N2_) / ripple_N2_;
  use_ = static_cast<double>(places_) < kLeastOfTurn * static_cast<double>(kBins)
             ? 0.0
             : std::clamp(matters, 0.0, 1.0) *
                   std::clamp((explained - kExplainsLittle) / (kExplainsMuch - kExplainsLittle), 0.0, 1.0);
  LearnAt(p.bin, 1.0 - p.share, error_N);
  LearnAt(p.next, p.share, error_N);
}

void AngleForceMap::LearnAt(std::size_t bin, double weight, double error_N) noexcept {
  const double gain =
      std::min(visit_ * std::max(1.0 / (visits_[bin] + first_visits_), rate_ / first_visits_), 1.0);
  force_N_[bin] = std::clamp(force_N_[bin] + weight * gain * error_N, -largest_N_, largest_N_);
  if (visits_[bin] == 0.0) ++places_;
  visits_[bin] += visit_ * weight;
}

}  // namespace contour
