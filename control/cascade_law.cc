#include "control/cascade_law.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/state_keeper.h"

namespace contour {
namespace {

// Smaller velocities and accelerations than these teach little.
constexpr double kSlowest_m_s = 0.02;
constexpr double kGentlest_m_s2 = 0.5;
constexpr double kBendRate_1_s = 40.0;
// An error above this is something else: a blow, or a torque limit.
constexpr double kLargestBend_m = 20e-6;

// In which a drive takes over what its offset no longer has, once the axis moves.
constexpr double kFades_s = 0.05;

// Nodes that the offset is made from.
constexpr std::size_t kNodes = 3;

bool Stands(const AxisHorizon& reference) noexcept {
  for (std::size_t n = 0; n < std::min(kNodes, reference.size()); ++n)
    if (reference[n].velocity_m_s != 0.0 || reference[n].acceleration_m_s2 != 0.0) return false;
  return true;
}

bool NothingMoves(const PerAxis<AxisHorizon>& references) noexcept {
  for (const AxisHorizon& reference : references)
    if (!Stands(reference)) return false;
  return true;
}

FrictionAhead Ahead(const FrictionPreview& friction, std::size_t index) noexcept {
  if (friction.empty()) return {};
  return friction[std::min(index, friction.size() - 1)];
}

}  // namespace

BendCorrection::BendCorrection(double period_s) noexcept
    : rate_(1.0 - std::exp(-kBendRate_1_s * period_s)), period_s_(period_s) {}

void BendCorrection::Learn(double error_m, double velocity_m_s, double acceleration_m_s2) noexcept {
  const double v = velocity_m_s / kSlowest_m_s, a = acceleration_m_s2 / kGentlest_m_s2;
  // Normalised least mean squares. Being late by d means d v - d^2 a / 2; what is left belongs to the bend.
  const double left_m = error_m - delay_s_ * (velocity_m_s - 0.5 * delay_s_ * acceleration_m_s2);
  const double step = rate_ * left_m / (1.0 + v * v + a * a);
  const double most_s = 3.0 * period_s_, most_s2 = period_s_ * period_s_;
  delay_s_ = std::clamp(delay_s_ + step * v / kSlowest_m_s, -most_s, most_s);
  share_s2_ = std::clamp(share_s2_ + step * a / kGentlest_m_s2, -most_s2, most_s2);
}

CascadeLaw::CascadeLaw(const PerAxis<ControlledAxis>& axes, double period_s)
    : axes_(axes), period_s_(period_s), fading_(std::exp(-period_s / kFades_s)) {
  for (const ControlledAxis& axis : axes_) {
    if (!(axis.mechanics.stiffness_N_m > 0.0))
      throw std::invalid_argument("cascade: wind-up compensation needs the screw's stiffness");
    states_.push_back({BendCorrection(period_s)});
  }
}

void CascadeLaw::Reset() noexcept {
  for (Axis& axis : states_) {
    axis.bend.Reset();
    axis.known = 0;
    axis.beyond_N = 0.0;
    axis.rests = false;
  }
  some_rest_ = false;
}

void CascadeLaw::Axis::Keep(StateKeeper& keep) noexcept {
  keep(bend, told, known, offset_N, beyond_N, rests);
}

void CascadeLaw::Keep(StateKeeper& keep) noexcept { keep(states_, share_, some_rest_); }

// The measured position belongs to t(k-1), the motor then to t(k-3/2): between the targets for t(k-2) and
// t(k-1), which were sent at t(k-3) and t(k-2). The newest target told is the one for t(k).
void CascadeLaw::Learn(Axis& axis, double position_m) noexcept {
  if (axis.known < axis.told.size()) return;
  const Told &later = axis.told[1], &earlier = axis.told[2];
  const double velocity_m_s = 0.5 * (later.velocity_m_s + earlier.velocity_m_s);
  const double acceleration_m_s2 = 0.5 * (later.acceleration_m_s2 + earlier.acceleration_m_s2);
  // The middle of the chord lies inside the bend.
  const double wanted_m =
      0.5 * (later.position_m + earlier.position_m) - 0.125 * period_s_ * period_s_ * acceleration_m_s2;
  const double error_m = wanted_m - position_m;
  if (!(std::abs(error_m) < kLargestBend_m + 3.0 * period_s_ * std::abs(velocity_m_s))) return;
  axis.bend.Learn(error_m, velocity_m_s, acceleration_m_s2);
}

bool CascadeLaw::Stays(Axis& axis, const AxisHorizon& reference, bool all_stand) noexcept {
  const bool rested = axis.rests;
  axis.rests = all_stand || (rested && Stands(reference));
  some_rest_ = some_rest_ || axis.rests;
  return rested && axis.rests;
}

double CascadeLaw::Offset_N(Axis& axis, double foreseen_N, bool stays) const noexcept {
  axis.beyond_N = stays ? axis.offset_N - foreseen_N : fading_ * axis.beyond_N;
  axis.offset_N = foreseen_N + axis.beyond_N;
  return axis.offset_N;
}

void CascadeLaw::Step(const ControlInput& input, ControlOutput& output) noexcept {
  output.iterations = 0;
  const bool all_stand = NothingMoves(Reference(input));
  const bool some_rest = some_rest_ || all_stand;
  some_rest_ = all_stand;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = states_[i];
    const AxisHorizon& reference = Reference(input)[i];
    const FrictionPreview& friction = input.friction[i];
    const Mechanics& m = axes_[i].mechanics;
    Learn(axis, input.estimate[i].position_m);
    // Node n is t(k-1+n).
    const auto windup = [&](std::size_t n) {
      const FrictionAhead f = Ahead(friction, n);
      return (f.node_N + m.table_mass_kg * PointAt(reference, n).acceleration_m_s2) / m.stiffness_N_m +
             f.lead_m;
    };
    const std::array<double, 3> w{windup(0), windup(1), windup(2)};
    const double w_acceleration = (w[2] - 2.0 * w[1] + w[0]) / (period_s_ * period_s_);
    // The drive moves the motor with its table; what winds the screw up moves the motor alone. It is half a
    // period behind its targets: what acts from t(k) to t(k+1) belongs to node 1.
    const double motor_m_s2 = PointAt(reference, 1).acceleration_m_s2 + w_acceleration;
    const double foreseen_N = 0.5 * (Ahead(friction, 0).mid_N + Ahead(friction, 1).mid_N) -
                              m.table_mass_kg * w_acceleration +
                              axes_[i].acceleration_share * m.mass_kg * motor_m_s2;
    const double wanted = Offset_N(axis, foreseen_N, some_rest && Stays(axis, reference, all_stand));
    const double limit = axes_[i].limits.force_N;
    const ReferencePoint& next = PointAt(reference, 2);
    output.feedforward_N[i] = wanted;
    output.force_N[i] = share_ * std::clamp(wanted, -limit, limit);
    output.limit[i] = std::abs(wanted) > limit ? Reason::kTorqueLimit : Reason::kNone;
    output.target_position_m[i] = next.position_m + w[2] + axis.bend.share_s2() * next.acceleration_m_s2;
    axis.told = {Told{next.position_m + w[2], next.velocity_m_s, next.acceleration_m_s2}, axis.told[0],
                 axis.told[1]};
    axis.known = std::min(axis.known + 1, axis.told.size());
  }
}

}  // namespace contour
