#include "control/cnc_law.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace contour {
namespace {

constexpr double kShortest_m = 1e-9;

/// Of the direction that `turned` says, between both at rest.
double Level_N(const ControlledAxis& axis, double turned) noexcept {
  return turned * (turned > 0.0 ? axis.coulomb_plus_N : axis.coulomb_minus_N);
}

}  // namespace

CncLaw::CncLaw(const CncConfig& config, const PerAxis<ControlledAxis>& axes, double period_s)
    : config_(config),
      axes_(axes),
      lead_cycles_(1e-3 * config.lead_ms / period_s),
      pulse_kept_(std::exp(-1e3 * period_s / config.pulse_ms)),
      turned_(axes.size()) {
  for (ControlledAxis& axis : axes_) {
    if (!(axis.mechanics.stiffness_N_m > 0.0))
      throw std::invalid_argument("cnc: lost motion needs the screw's stiffness");
    // Without friction there is nothing to turn round, however fast.
    if (!(axis.presliding_m > kShortest_m)) axis.presliding_m = kShortest_m;
  }
}

void CncLaw::Reset() noexcept {
  for (Turned& turned : turned_) turned = {};
}

void CncLaw::Keep(StateKeeper& keep) noexcept { keep(turned_, share_); }

ReferencePoint CncLaw::Ahead(const AxisHorizon& reference) const noexcept {
  const auto whole = static_cast<std::size_t>(lead_cycles_);
  const double rest = lead_cycles_ - static_cast<double>(whole);
  const ReferencePoint &from = PointAt(reference, 1 + whole), &to = PointAt(reference, 2 + whole);
  ReferencePoint at = from;
  at.position_m += rest * (to.position_m - from.position_m);
  at.velocity_m_s += rest * (to.velocity_m_s - from.velocity_m_s);
  return at;
}

void CncLaw::Follow(const ControlledAxis& axis, double target_m, double torque_m,
                    Turned& turned) const noexcept {
  const double moved_m = turned.begun ? target_m - turned.target_m : 0.0;
  const double torque_moved_m = turned.begun ? torque_m - turned.torque_m : 0.0;
  turned.target_m = target_m;
  turned.torque_m = torque_m;
  turned.begun = true;
  const double lost_travel_m = config_.lost_motion_travel_rel * axis.presliding_m;
  turned.lost_motion = std::clamp(turned.lost_motion + moved_m / lost_travel_m, -1.0, 1.0);
  turned.pulse *= pulse_kept_;
  if (torque_moved_m == 0.0) return;
  const double direction = torque_moved_m > 0.0 ? 1.0 : -1.0;
  const double friction_travel_m = config_.friction_travel_rel * axis.presliding_m;
  turned.friction +=
      (direction - turned.friction) * (1.0 - std::exp(-std::abs(torque_moved_m) / friction_travel_m));
  if (direction * turned.direction < 0.0) turned.pulse = direction;
  turned.direction = direction;
}

// The target is for t(k+1). Drives that interpolate run half a period behind their targets: the torque of
// [t(k), t(k+1)) meets the motor where the reference is at t(k).
void CncLaw::Step(const ControlInput& input, ControlOutput& output) noexcept {
  output.iterations = 0;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const ControlledAxis& axis = axes_[i];
    const AxisHorizon& reference = Reference(input)[i];
    const ReferencePoint& next = PointAt(reference, 2);
    const ReferencePoint ahead = Ahead(reference);
    Turned& turned = turned_[i];
    Follow(axis, next.position_m, ahead.position_m, turned);
    const double windup_N = config_.lost_motion_share * Level_N(axis, turned.lost_motion) +
                            config_.bend_share * axis.mechanics.table_mass_kg * next.acceleration_m_s2;
    const double wanted = config_.friction_share * Level_N(axis, turned.friction) +
                          config_.pulse_share * Level_N(axis, turned.pulse) +
                          config_.viscous_share * axis.viscous_Ns_m * ahead.velocity_m_s;
    const double limit = axis.limits.force_N;
    output.feedforward_N[i] = wanted;
    output.force_N[i] = share_ * std::clamp(wanted, -limit, limit);
    output.limit[i] = std::abs(wanted) > limit ? Reason::kTorqueLimit : Reason::kNone;
    output.target_position_m[i] = next.position_m + windup_N / axis.mechanics.stiffness_N_m;
  }
}

}  // namespace contour
