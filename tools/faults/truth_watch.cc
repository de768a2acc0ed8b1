#include "tools/faults/truth_watch.h"

#include <algorithm>
#include <cmath>

namespace contour::faults {
namespace {

/// Below this nothing that matters moves or pushes.
constexpr double kRest_m_s = 1e-4;
constexpr double kNoTorque_Nm = 1e-4;

bool InControl(DriveState s) noexcept {
  return s == DriveState::kOperationEnabled || s == DriveState::kQuickStopActive ||
         s == DriveState::kFaultReactionActive;
}

}  // namespace

bool TruthWatch::UnderTorque(const AxisTruth& truth) noexcept {
  return InControl(truth.drive_state) || std::abs(truth.torque_Nm) > kNoTorque_Nm;
}

bool TruthWatch::AtRest(const AxisTruth& truth) noexcept {
  return std::abs(truth.motor_velocity_m_s) < kRest_m_s && std::abs(truth.table_velocity_m_s) < kRest_m_s;
}

void TruthWatch::Begin(const TruthRow& newest) noexcept {
  begun_ = true;
  begin_s_ = now_s_ = newest.time_s;
}

// The record's reference belongs to an instant that lies a whole number of periods after the last pair, and
// the truth is up to two periods younger: the reference is carried on to it.
void TruthWatch::Follow(const CycleRecord& record, const TruthRow& newest, bool holds) noexcept {
  now_s_ = newest.time_s;
  const double reference_s = paired_s_ + static_cast<double>(record.cycle - paired_cycle_) * period_s_;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& a = axes_[i];
    const AxisTruth& truth = newest.axes[i];
    // A drive that restarts counts anew; the path stays where it was.
    if (!begun_) a.zero_m = truth.encoder_zero_m;
    const double motor_m = truth.motor_position_m - a.zero_m;
    if (holds) {
      const ReferencePoint& r = record.axes[i].reference;
      const double commanded_m = r.position_m + r.velocity_m_s * (newest.time_s - reference_s);
      // Broken before anything was commanded: what is held is where the axis stands, whatever its encoder
      // calls that.
      if (begun_ && !a.has_command) a.stands_m = motor_m - commanded_m;
      a.commanded_m = commanded_m + a.stands_m;
      a.has_command = true;
    }
    // Without torque it is off at once, but its departure counts as long as it is commanded.
    const bool torque = UnderTorque(truth) && (holds || !a.powerless);
    if (!begun_ || !torque) continue;
    if (a.has_command) a.departure_m = std::max(a.departure_m, std::abs(motor_m - a.commanded_m));
    if (!AtRest(truth)) a.moving_until_s = since_fault_s();
  }
}

}  // namespace contour::faults
