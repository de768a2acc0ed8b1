#include "daemon/rt/cycle.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

// What the axes do and what holds them back, as of the newest feedback.
namespace contour {
namespace {

/// Of what a reading is off by, what lateness must leave of it at most to have made it.
constexpr double kExplains = 0.5;
/// Of what readings are expected to be off by, what lateness must move one by: less of it fits by chance.
constexpr double kBeyondExpected = 2.0;

}  // namespace

// A SYNC that another frame held up latches a later position. Where the bus tells when it was on the wire,
// that is known, however little it is, to what the time stamp is worth: what is nearer to where the axis was
// foreseen tells. Where it does not, the answer comes as much later; but the answer alone may be late as
// well.
void Cycle::TakeLateness(std::size_t index, const AxisFeedback& feedback) noexcept {
  Axis& axis = axes_[index];
  const AxisEstimate& foreseen = estimates_[index];
  const double matters_m = std::max(axis.late_from_m, kBeyondExpected * foreseen.innovation_std_m);
  double off_m = axis.position_m - foreseen.predicted_position_m;
  const double known_m = feedback.sync_late_s * foreseen.predicted_velocity_m_s;
  if (std::abs(known_m) > matters_m && std::abs(off_m - known_m) < std::abs(off_m)) {
    axis.position_m -= known_m;
    off_m -= known_m;
  }
  if (feedback.late_s <= axis.late_from_s) return;
  const double late_m = feedback.late_s * foreseen.predicted_velocity_m_s;
  if (std::abs(late_m) > matters_m && std::abs(off_m - late_m) < kExplains * std::abs(off_m))
    axis.position_m -= late_m;
}

// The scale was read at the same instant.
double Cycle::TableAt_m(std::size_t index, const AxisFeedback& feedback) const noexcept {
  const Axis& axis = axes_[index];
  return feedback.table_position_m + axis.position_m - feedback.position_rad * axis.radius_m_rad;
}

const Cycle::Estimates& Cycle::Estimate(const Feedback& feedback, const IoInput& io) noexcept {
  const bool holds = transitions_.holds_torque();
  std::size_t moving = 0;
  for (std::size_t i = 0; i < axis_count_; ++i) moving += AtSample(i).velocity_m_s != 0.0 ? 1u : 0u;
  for (std::size_t i = 0; i < axis_count_; ++i) {
    Axis& axis = axes_[i];
    const AxisFeedback& f = feedback[i];
    const ReferencePoint& commanded = AtSample(i);
    AxisEstimatorInput input;
    input.position_m = axis.position_m;
    input.fresh = f.fresh && axis.monitor.believed();
    if (f.has_scale) input.scale_m = TableAt_m(i, f);
    input.scale_fresh = f.scale_fresh;
    input.force_N = axis.sent_force_N;
    if (by_reported_torque_) {
      // What the drive's own loops made of it, at the ends of the period that has passed.
      const double now_N = f.torque_Nm / axis.radius_m_rad;
      const double acted_N = axis.sent_force_N[axis.acts_after];
      const double mean_N = axis.in_period.Mean_N(axis.reported_N, now_N, acted_N);
      input.force_N = {now_N, two_inertias_ ? mean_N : 0.5 * (now_N + axis.reported_N), axis.reported_N};
      axis.reported_N = now_N;
    }
    input.commanded_velocity_m_s = commanded.velocity_m_s;
    input.commanded_acceleration_m_s2 = commanded.acceleration_m_s2;
    if (io.configured && io.fresh) input.temperature_degC = io.screw_temperature_degC;
    input.alone = moving == (commanded.velocity_m_s != 0.0 ? 1u : 0u);
    // An experiment pushes the axis although nothing commands it to move.
    input.at_rest = commanded.velocity_m_s == 0.0 && commanded.extra_torque_Nm == 0.0;
    input.enabled = holds && f.drive_state == DriveState::kOperationEnabled;
    estimates_[i] = axis.estimator.Update(input);
    if (fallback_ != nullptr && watch_.step() >= SupervisionStep::kSoftened) {
      const AxisEstimate observed = axis.observer.Update(input);
      if (fallen_back()) estimates_[i] = observed;
    }
    if (skipped_ != 0) CatchUp(axis, i, input);
  }
  return estimates_;
}

// From the newest feedback to one period before the torque now being computed, under the torque that acted.
void Cycle::CatchUp(Axis& axis, std::size_t index, AxisEstimatorInput input) noexcept {
  const AxisEstimate measured = estimates_[index];
  AxisEstimator& estimator = fallen_back() ? axis.observer : axis.estimator;
  const double held_N = input.force_N[0];
  input.fresh = input.scale_fresh = false;
  input.force_N = {held_N, held_N, held_N};
  for (std::uint32_t s = 1; s <= skipped_; ++s) {
    const ReferencePoint commanded = follower_.Near(index, static_cast<int>(s) - static_cast<int>(skipped_));
    input.commanded_velocity_m_s = commanded.velocity_m_s;
    input.commanded_acceleration_m_s2 = commanded.acceleration_m_s2;
    estimates_[index] = estimator.Update(input);
    axis.sent_force_N = {held_N, axis.sent_force_N[0], axis.sent_force_N[1]};
  }
  AxisEstimate& now = estimates_[index];
  now.innovation_m = measured.innovation_m;
  now.innovation_std_m = measured.innovation_std_m;
  if (now.limit == Reason::kNone) now.limit = measured.limit;
  if (now.scale == Reason::kNone) now.scale = measured.scale;
  now.diverged = now.diverged || measured.diverged;
}

}  // namespace contour
