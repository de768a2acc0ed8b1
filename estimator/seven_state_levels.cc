// What the friction levels may be, beside what the filter makes of them: see docs/estimator.md.
#include <algorithm>
#include <cmath>

#include "estimator/seven_state_filter.h"
#include "estimator/share_of_period.h"

namespace contour {
namespace {

// A bristle below this share of the level after so many presliding lengths of travel: the level is not there.
// Even with a third of the commissioned stiffness a real one has come to 1 - exp(-4/3) = 0.74 by then.
constexpr double kMissingShare = 0.3;
constexpr double kSettledLengths = 4.0;
constexpr double kSettled_s = 0.05;
// By how much the level then comes down per presliding length.
constexpr double kGivingUpShare = 0.3;
// What must hold the axis back for a level that was given up to be taken back, in doubts.
constexpr double kTakenBackDoubts = 4.0;
// Standard deviation of a level, at most this share of it.
constexpr double kLargestLevelStd = 0.25;
// Lowest level, of the commissioned one: an axis may turn out to have hardly any friction.
constexpr double kLowestLevelShare = 1e-4;
// A level that has come down to that share of the commissioned one has been given up, and is about to be.
constexpr double kGivenUpShare = 0.2;
constexpr double kComingDownShare = 0.5;

}  // namespace

// After some presliding lengths g / sigma0 of travel in one direction the bristle has come to the level:
// F = g (1 - exp(-sigma0 x / g)). If it stays far below, there is not that much friction, but the filter
// cannot see that by itself: far from the level, F does not depend on it (dF/dg = 0 at F = 0). So the level
// comes down by travel. Nor does a level of nearly nothing come up again by itself: it is taken from what
// holds the axis back.
template <class Core>
void SevenStateFilter<Core>::JudgeLevel(bool at_rest) noexcept {
  auto& x = core_.x;
  const int direction = LevelState() == kLevelPlus ? 1 : -1;
  if (direction != travel_direction_) {
    travel_direction_ = direction;
    travel_m_ = travel_s_ = 0.0;
  }
  const double step_m = std::abs(x[kVelocity]) * setup_.period_s;
  travel_m_ += step_m;
  travel_s_ += setup_.period_s;
  if (at_rest || !adapts()) return;
  const double level_N = Level_N();
  // By the commissioned stiffness: the estimated one goes down instead of the level when there is no
  // friction.
  const double length_m = level_N / setup_.friction.sigma0_N_m;
  // A disturbance as small as an error of the level would be is an error of the level.
  const double doubt_N = setup_.config.level_error * CommissionedLevel_N();
  const double held_N =
      direction * (x[kBristle] + std::clamp(x[kDisturbance] - lasting_N_, -doubt_N, doubt_N));
  double& level = x[LevelState()];
  // A jerk may take the axis over all the lengths before the filter has seen what held it back.
  const bool settled = travel_m_ > kSettledLengths * length_m && travel_s_ > kSettled_s;
  // A drive that holds the axis by itself, with a wrong mass in the model, looks like a missing level.
  if (!setup_.reported_torque && settled && held_N <= kMissingShare * level_N) {
    level *= std::exp(-kGivingUpShare * step_m / length_m);
    // Nothing to act upon is left of it.
    if (level < doubt_N) level = kLowestLevelShare * CommissionedLevel_N();
    // The bristle comes down with its level; what it held besides was no friction.
    const double lowered_N = Level_N();
    const double excess_N = x[kBristle] - std::clamp(x[kBristle], -lowered_N, lowered_N);
    x[kBristle] -= excess_N;
    x[kDisturbance] += excess_N;
  } else if (travel_m_ > kSettledLengths * CommissionedLevel_N() / setup_.friction.sigma0_N_m) {
    TakeLevelBack(direction * (x[kBristle] + x[kDisturbance] - lasting_N_), kTakenBackDoubts * doubt_N);
  }
}

template <class Core>
void SevenStateFilter<Core>::TakeLevelBack(double held_N, double least_N) noexcept {
  if (held_N < least_N || Level_N() > kMissingShare * held_N) return;
  auto& x = core_.x;
  const std::size_t i = LevelState();
  x[i] *= held_N / Level_N();
  x[kBristle] += x[kDisturbance] - lasting_N_;
  x[kDisturbance] = lasting_N_;
  const double share = initial_std_[i] / std::sqrt(core_.Variance(i));
  for (double& s : core_.s[i]) s *= share;
}

// Beyond what an error of the level may be, a disturbance is a force from outside. It does not fade, or the
// levels would have to take it up, of which one would come down to nothing.
template <class Core>
void SevenStateFilter<Core>::HoldLastingForce() noexcept {
  const double room_N = setup_.config.lasting_force * CommissionedLevel_N();
  const double beyond_N = core_.x[kDisturbance] - lasting_N_;
  lasting_N_ += beyond_N - std::clamp(beyond_N, -room_N, room_N);
  if (std::abs(lasting_N_) > room_N) lasting_N_ += lasting_share_ * (core_.x[kDisturbance] - lasting_N_);
}

// A force from outside and levels that differ by as much between the directions are the same to one encoder.
// More asymmetry than a model may lack is such a force.
template <class Core>
void SevenStateFilter<Core>::ShareAsymmetry() noexcept {
  auto& x = core_.x;
  const Friction& f = setup_.friction;
  const double most_N = setup_.config.level_asymmetry * 0.5 * (f.Fc_plus_N + f.Fc_minus_N);
  const double asymmetry_N = 0.5 * ((x[kLevelPlus] - f.Fc_plus_N) - (x[kLevelMinus] - f.Fc_minus_N));
  const double beyond_N = asymmetry_N - std::clamp(asymmetry_N, -most_N, most_N);
  const double excess_N = std::clamp(beyond_N, -asymmetry_share_ * most_N, asymmetry_share_ * most_N);
  x[kLevelPlus] -= excess_N;
  x[kLevelMinus] += excess_N;
  x[kBristle] -= excess_N;
  x[kDisturbance] += excess_N;
  lasting_N_ += excess_N;
}

template <class Core>
bool SevenStateFilter<Core>::Bound() noexcept {
  bool bounded = false;
  const auto clamp = [&bounded](double& value, double low, double high) {
    if (value < low || value > high) {
      value = std::clamp(value, low, high);
      bounded = true;
    }
  };
  const auto& c = setup_.config;
  const Friction& f = setup_.friction;
  auto& x = core_.x;
  clamp(x[kLevelPlus], f.Fc_plus_N * kLowestLevelShare, f.Fc_plus_N * c.level_range);
  clamp(x[kLevelMinus], f.Fc_minus_N * kLowestLevelShare, f.Fc_minus_N * c.level_range);
  clamp(x[kLogSigma0], -c.log_sigma0_range, c.log_sigma0_range);
  // No bristle holds more than the largest level: the rest is a force from outside.
  const double most_N = c.level_range * std::max(f.Fs_plus_N, f.Fs_minus_N);
  const double rest_N = x[kBristle] - std::clamp(x[kBristle], -most_N, most_N);
  x[kBristle] -= rest_N;
  x[kDisturbance] += rest_N;
  // A level is positive: its sigma points must be too. Scaling a row of S scales that state's deviation and
  // keeps its correlations.
  for (const auto i : {kLevelPlus, kLevelMinus}) {
    const double share = kLargestLevelStd * x[i] / std::sqrt(core_.Variance(i));
    if (share < 1.0)
      for (double& s : core_.s[i]) s *= share;
  }
  return bounded;
}

template <class Core>
void SevenStateFilter<Core>::JudgeOutsideForce() noexcept {
  const Friction& f = setup_.friction;
  const double plus = core_.x[kLevelPlus] / f.Fc_plus_N, minus = core_.x[kLevelMinus] / f.Fc_minus_N;
  // Without any level there is nothing to tell an outside force from: it may be friction that comes back.
  if (std::max(plus, minus) < kGivenUpShare) {
    lasting_N_ = 0.0;
    return;
  }
  HoldLastingForce();
  // A level that comes down where there is no outside force is being given up; the other one will be next.
  if (lasting_N_ != 0.0 || std::min(plus, minus) > kComingDownShare) ShareAsymmetry();
}

// A level at its upper bound is what the filter had no other name for. Where the axis rests nothing depends
// on it, and it begins again from the commissioned value, as uncertain as that is. The lower bound is an axis
// with hardly any friction: that is an answer.
template <class Core>
void SevenStateFilter<Core>::LeaveBounds() noexcept {
  auto& x = core_.x;
  for (const auto i : {kLevelPlus, kLevelMinus}) {
    const double commissioned_N = i == kLevelPlus ? setup_.friction.Fc_plus_N : setup_.friction.Fc_minus_N;
    if (x[i] < kAtBound * setup_.config.level_range * commissioned_N) continue;
    x[i] = commissioned_N;
    const double share = initial_std_[i] / std::sqrt(core_.Variance(i));
    for (double& s : core_.s[i]) s *= share;
  }
}

template void SevenStateFilter<SqrtUkf<kSevenStates>>::LeaveBounds() noexcept;
template void SevenStateFilter<SqrtEkf<kSevenStates>>::LeaveBounds() noexcept;
template void SevenStateFilter<SqrtUkf<kSevenStates>>::JudgeLevel(bool) noexcept;
template void SevenStateFilter<SqrtEkf<kSevenStates>>::JudgeLevel(bool) noexcept;
template void SevenStateFilter<SqrtUkf<kSevenStates>>::TakeLevelBack(double, double) noexcept;
template void SevenStateFilter<SqrtEkf<kSevenStates>>::TakeLevelBack(double, double) noexcept;
template void SevenStateFilter<SqrtUkf<kSevenStates>>::HoldLastingForce() noexcept;
template void SevenStateFilter<SqrtEkf<kSevenStates>>::HoldLastingForce() noexcept;
template void SevenStateFilter<SqrtUkf<kSevenStates>>::ShareAsymmetry() noexcept;
template void SevenStateFilter<SqrtEkf<kSevenStates>>::ShareAsymmetry() noexcept;
template void SevenStateFilter<SqrtUkf<kSevenStates>>::JudgeOutsideForce() noexcept;
template void SevenStateFilter<SqrtEkf<kSevenStates>>::JudgeOutsideForce() noexcept;
template bool SevenStateFilter<SqrtUkf<kSevenStates>>::Bound() noexcept;
template bool SevenStateFilter<SqrtEkf<kSevenStates>>::Bound() noexcept;

}  // namespace contour
