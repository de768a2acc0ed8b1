#include "core/spring_loop.h"

#include <algorithm>
#include <cmath>

namespace contour {
namespace {

// Of what the loop holds the axis by.
constexpr double kStiffestShare = 0.5;

double PositionGain_N_m(const TwoInertiaLoop& loop) noexcept {
  return loop.regulator_motion[0] + loop.regulator_motion[2];
}

/// What is added to a command per newton that stays: the motor's force and all commands under way.
double ForceGain(const TwoInertiaLoop& loop) noexcept {
  double gain = loop.regulator_motion[4];
  for (std::size_t i = 0; i < loop.queued; ++i) gain += loop.regulator_queue[i];
  return gain;
}

}  // namespace

double HoldingStiffness_N_m(const TwoInertiaLoop& loop) noexcept {
  return PositionGain_N_m(loop) / (1.0 + ForceGain(loop));
}

double StiffestSpring_N_m(const TwoInertiaLoop& loop) noexcept {
  return kStiffestShare * std::max(0.0, HoldingStiffness_N_m(loop));
}

// k = s^2 P / (1 + s G), P the gain of positions and G that of forces.
SpringShares SharesOfSpring(const TwoInertiaLoop& loop, double spring_N_m) noexcept {
  const double k = std::clamp(spring_N_m, 0.0, StiffestSpring_N_m(loop));
  const double p = PositionGain_N_m(loop), kg = k * ForceGain(loop);
  const double s = (kg + std::sqrt(kg * kg + 4.0 * k * p)) / (2.0 * p);
  return {s * s, s};
}

TwoInertiaLoop SpringLoop(const TwoInertiaLoop& loop, double spring_N_m) noexcept {
  const SpringShares share = SharesOfSpring(loop, spring_N_m);
  TwoInertiaLoop spring = loop;
  for (std::size_t i = 0; i < kLoopMotion; ++i)
    spring.regulator_motion[i] *= i == 0 || i == 2 ? share.position : share.velocity;
  for (double& gain : spring.regulator_queue) gain *= share.velocity;
  spring.disturbance_to_command = 0.0;
  return spring;
}

}  // namespace contour
