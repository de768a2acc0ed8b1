#include "daemon/rt/cycle.h"

#include <algorithm>
#include <cstddef>

// The wanted force: the controller in use, and what supervision makes of it.
namespace contour {
namespace {

/// Whether carrying these orders out touches what is followed.
bool ChangesPath(const Orders& o) noexcept {
  return o.hold_here || o.forget_path || o.expect_path || o.start_path || o.stop_path || o.shorten_stop ||
         !o.torque_allowed;
}

}  // namespace

// The ladder's step of this cycle, and what controllers and estimators have to do with it.
void Cycle::WatchItself(const Feedback& feedback, const Estimates& estimate) noexcept {
  const bool had_fallen_back = fallen_back();
  if (transitions_.holds_torque() && Acts(Watch::kSelfWatch)) {
    for (std::size_t i = 0; i < axis_count_; ++i)
      watch_.Look(i, {feedback[i], estimate[i], AtSample(i), axes_[i].position_m, axes_[i].radius_m_rad,
                      control_out_.limit[i] == Reason::kSolverCap});
    watch_.EndCycle(late_);
  } else {
    watch_.Reset();
  }
  if (acted_ == watch_.step()) return;
  const bool soft = watch_.step() >= SupervisionStep::kSoftened;
  controller_.Soften(watch_.softness());
  for (Axis& axis : axes_) {
    axis.estimator.Freeze(soft);
    if (soft && acted_ < SupervisionStep::kSoftened) axis.observer.Reset(axis.position_m);
  }
  if (fallen_back() != had_fallen_back) controller().Reset();
  // To be noticed changes nothing.
  // The loop of two inertias stays the same law with the same observer. What it sent last in a swing is no
  // force to go on from.
  take_over_ = !same_law_ && transitions_.holds_torque() &&
               std::max(acted_, watch_.step()) >= SupervisionStep::kSoftened;
  acted_ = watch_.step();
  TellLoop();
}

// The motion monitors go by the loop that acts: reloaded, softened, or the one fallen back to.
void Cycle::TellLoop() noexcept {
  const bool soft = watch_.step() >= SupervisionStep::kSoftened && !fallen_back();
  const double loop_Hz = controller().loop_Hz(soft);
  for (Axis& axis : axes_) axis.monitor.UseLoop(loop_Hz);
}

const ControlOutput& Cycle::Decide(const Orders& orders, const Estimates& estimate) noexcept {
  // The path ahead is what Observe found, unless an order has just changed it.
  if (ChangesPath(orders))
    for (std::size_t i = 0; i < axis_count_; ++i)
      follower_.Horizon(i, controller().horizon_points(), control_in_.reference[i]);
  ContourController& in_use = controller();
  in_use.Plan(control_in_, orders.torque_allowed);
  for (std::size_t i = 0; i < axis_count_; ++i) {
    AxisEstimator& estimator = fallen_back() ? axes_[i].observer : axes_[i].estimator;
    estimator.PreviewFriction(Reference(control_in_)[i], in_use.friction_points(), control_in_.friction[i]);
    control_in_.previous_force_N[i] = axes_[i].sent_force_N[0];
    control_in_.estimate[i] = estimate[i];
  }
  control_in_.skipped = skipped_;
  if (orders.torque_allowed) {
    in_use.Step(control_in_, control_out_);
    Blend();
  } else {
    // Whatever it found would not be sent, and axes that are moved by hand would keep its solver busy.
    in_use.Rest(control_out_);
    for (Axis& axis : axes_) axis.blend_N = 0.0;
  }
  return control_out_;
}

// A change of controller takes over the force that is there; the difference fades.
void Cycle::Blend() noexcept {
  for (std::size_t i = 0; i < axis_count_; ++i) {
    double& blend_N = axes_[i].blend_N;
    if (take_over_) blend_N = axes_[i].sent_force_N[0] - control_out_.force_N[i];
    if (!controller().HoldsBySpring(control_in_, i)) control_out_.force_N[i] += blend_N;
    blend_N *= blend_kept_;
  }
  take_over_ = false;
}

}  // namespace contour
