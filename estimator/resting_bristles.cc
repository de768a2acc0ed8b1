#include "estimator/resting_bristles.h"

#include <algorithm>
#include <cmath>

namespace contour {
namespace {

// Slower than the noise of the force, faster than bristles give way.
constexpr double kFollows_s = 0.05;
// Of the level: as little shows nothing.
constexpr double kLeastCarried = 0.1;
// Of what they carried; what is nothing could not come back.
constexpr double kLeastShare = 0.02;

}  // namespace

RestingBristles::RestingBristles(double level_N, double lasting_share, double period_s) noexcept
    : most_unexplained_N_(lasting_share * level_N),
      least_carried_N_(kLeastCarried * level_N),
      rate_(std::min(1.0, period_s / kFollows_s)),
      window_(period_s) {}

void RestingBristles::Move() noexcept {
  share_ = 1.0;
  outside_N_ = 0.0;
  window_.Move();
}

double RestingBristles::Step(double carried_N, double unexplained_N, double noise_takes_s) noexcept {
  const double rate = window_.Rest(rate_, noise_takes_s);
  const double whole_N = carried_N / share_;
  if (!(std::abs(whole_N) > least_carried_N_)) return 1.0;
  if (std::abs(unexplained_N) < most_unexplained_N_) outside_N_ = 0.0;
  const double beyond_N = unexplained_N - outside_N_;
  const double given_way_N = std::clamp(beyond_N, -most_unexplained_N_, most_unexplained_N_);
  outside_N_ += beyond_N - given_way_N;
  const double wanted = std::clamp((carried_N + given_way_N) / whole_N, kLeastShare, 1.0);
  const double before = share_;
  share_ += rate * (wanted - share_);
  return share_ / before;
}

}  // namespace contour
