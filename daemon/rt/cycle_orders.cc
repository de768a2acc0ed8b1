#include "daemon/rt/cycle.h"

#include <cstddef>
#include <cstdint>

// What the machine state orders, carried out.
namespace contour {

void Cycle::CarryOut(const Orders& orders, const Request& request) noexcept {
  DoubtPosition(orders);
  if (orders.reference) TellWhere(request);
  if (orders.start_bring_up) master_.StartBringUp();
  if (orders.fall_silent) master_.FallSilent();
  if (orders.hold_here) HoldHere();
  if (orders.forget_path) {
    PerAxis<double> here;
    for (std::size_t i = 0; i < axis_count_; ++i) here.push_back(control_in_.reference[i][0].position_m);
    follower_.Hold(here);
  }
  // Where nothing is held, the reference is where the axes are: nothing jumps when they are enabled.
  if (!orders.torque_allowed) FollowFeedback();
  if (orders.expect_path) follower_.Expect(transitions_.program_id());
  if (orders.start_path) {
    TellStatedForces();
    follower_.Start();
  }
  if (orders.stop_path)
    follower_.BeginStop(orders.within_limits ? PathFollower::StopKind::kWithinLimits
                                             : PathFollower::StopKind::kShortest);
  if (orders.shorten_stop) follower_.BeginStop(PathFollower::StopKind::kShortest);
}

// An experiment's spring, which would give way under a weight, holds an axis where its program began.
[[gnu::cold, gnu::noinline]] void Cycle::TellStatedForces() noexcept {
  for (std::size_t i = 0; i < axis_count_; ++i) {
    const double at_m = control_in_.reference[i][0].position_m;
    control_in_.stated[i] = {axes_[i].known.Constant_N(), axes_[i].known.TableForce_N(at_m)};
  }
}

// An incremental encoder that was not believed, or seemed faster than its axis can be, may have lost counts.
void Cycle::DoubtPosition(const Orders& orders) noexcept {
  if (transitions_.state() != MachineState::kFaulted) return;
  const std::uint8_t axis = transitions_.reason_where();
  if (axis >= axis_count_) return;
  switch (transitions_.reason()) {
    case Reason::kFeedbackFrozen:
    case Reason::kFeedbackJump:
    case Reason::kFeedbackReversed:
    case Reason::kTorqueWithoutMotion:  // of a standing reading under a torque that was not reported yet, too
    case Reason::kVelocityLimit:
      master_.DoubtPosition(axis);
      return;
    case Reason::kOscillation:  // what takes the voltage away as a swing may be counts that are lost, too
      if (orders.voltage_off < axis_count_) master_.DoubtPosition(orders.voltage_off);
      return;
    default:
      return;
  }
}

void Cycle::TellWhere(const Request& request) noexcept {
  const ReferenceRequest told = DecodeReference(request.program_id);
  Axis& axis = axes_[told.axis];
  master_.TellPosition(told.axis, told.position_m / axis.radius_m_rad);
  axis.position_m = axis.seen_at_m = told.position_m;
}

void Cycle::HoldHere() noexcept {
  PerAxis<double> here;
  for (Axis& axis : axes_) {
    axis.estimator.Reset(axis.position_m);
    here.push_back(axis.estimator.StandsAt_m(axis.position_m));
    axis.sent_force_N = {};
  }
  follower_.Hold(here);
  controller_.Reset();
  guard_.Reset();
  for (std::size_t i = 0; i < axis_count_; ++i) {
    if (IsReferenced(master_.reference(i))) continue;
    const Axis& axis = axes_[i];
    // Where no program is allowed the axis only holds.
    const bool moves = master_.reference(i) == ReferenceState::kNeverTold && axis.unreferenced_travel_m > 0.0;
    guard_.Confine(i, moves ? axis.unreferenced_travel_m : axis.following_error_m);
  }
}

void Cycle::FollowFeedback() noexcept {
  PerAxis<double> here;
  for (const Axis& axis : axes_) here.push_back(axis.estimator.StandsAt_m(axis.position_m));
  follower_.Hold(here);
}

}  // namespace contour
