#include "daemon/rt/reason_watch.h"

namespace contour {

void ReasonWatch::Update(const Transitions& machine, const DriveMaster& master) noexcept {
  if (machine.reason() != reason_ || machine.reason_where() != where_) {
    reason_ = machine.reason();
    where_ = machine.reason_where();
    Arose(master, machine.stayed());
  } else if (detail_.emergency_code == 0 && age_ < kSoonAfter_cycles && OfDrive(master)) {
    ++age_;
    detail_.emergency_code = master.status()[where_].emergency_cause;
  }
  if (machine.state() == MachineState::kFaulted) LookForSlowStops(master);
}

void ReasonWatch::Arose(const DriveMaster& master, std::uint32_t stayed_cycles) noexcept {
  detail_ = {};
  age_ = 0;
  std::uint64_t waited_cycles = reason_ == Reason::kStopTimeout ? stayed_cycles : 0;
  if (reason_ == Reason::kGridPointsSkipped) waited_cycles = master.elapsed_cycles();
  if (OfDrive(master)) {
    const AxisDriveStatus& s = master.status()[where_];
    detail_.drive_state = master.feedback()[where_].drive_state;
    detail_.emergency_code = s.emergency_cause;
    if (reason_ == Reason::kHeartbeatLost) waited_cycles = s.silent_cycles;
    if (reason_ == Reason::kEnableTimeout) waited_cycles = s.in_state_cycles;
  }
  detail_.waited_us = waited_cycles * cycle_us_;
}

void ReasonWatch::LookForSlowStops(const DriveMaster& master) noexcept {
  for (std::size_t i = 0; i < master.status().size() && detail_.slow_quick_stop == 0xFF; ++i) {
    const AxisDriveStatus& s = master.status()[i];
    const DriveState state = master.feedback()[i].drive_state;
    const bool stops = state == DriveState::kOperationEnabled || state == DriveState::kQuickStopActive ||
                       state == DriveState::kFaultReactionActive;
    // Of a drive that is silent, nobody knows.
    if (!s.transition_late || !stops || s.goal != DriveGoal::kQuickStop || !master.feedback()[i].fresh)
      continue;
    detail_.slow_quick_stop = static_cast<std::uint8_t>(i);
    detail_.slow_quick_stop_us = s.in_state_cycles * cycle_us_;
  }
}

bool ReasonWatch::OfDrive(const DriveMaster& master) const noexcept {
  return IsFault(reason_) && !IsOfBus(reason_) && where_ < master.status().size();
}

}  // namespace contour
