#include "daemon/rt/cycle.h"

#include <cstddef>
#include <cstdint>

#include "control/contour_error.h"

// The record of a cycle. Nothing that the frames need.
namespace contour {
namespace {

/// Lock-step time may stand still when nothing has changed for so many cycles.
constexpr std::uint32_t kSettledCycles = 300;
/// The same after a fault whose end cannot be seen, because the drives are out of reach.
constexpr std::uint32_t kFaultSettledCycles = 3000;
/// Reference points to either side of the feedback's instant that make the local path of the contour error.
constexpr int kLocalPathReach = 8;

}  // namespace

void Cycle::Report(const CycleInput& in, CycleOutput& out) noexcept CONTOUR_NONBLOCKING {
  CycleRecord& r = out.record;
  r.cycle = in.cycle;
  r.grid_time_ns = in.grid_time_ns;
  r.sync_number = master_.sync_number();
  r.feedback_sync = master_.feedback_sync();
  r.state = transitions_.state();
  r.reason = transitions_.reason();
  r.reason_axis = transitions_.reason_where();
  r.reason_detail = reasons_.detail();
  r.acknowledged = transitions_.acknowledged();
  r.acknowledged_ok = transitions_.acknowledged_ok();
  r.program_id = transitions_.program_id();
  const ProgramPlace place = follower_.program_place();
  r.path_time_s = place.time_s;
  r.pace = place.pace;
  r.program_line = place.line;
  r.path_points_waiting = static_cast<std::uint16_t>(follower_.waiting());
  r.solver_iterations = static_cast<std::uint16_t>(control_out_.iterations);
  r.stale_cycles = stale_cycles_;
  r.io = in.io;
  r.bring_up = master_.bring_up();
  r.axes.resize(axis_count_);
  for (std::size_t i = 0; i < axis_count_; ++i) RecordAxis(i, r.axes[i]);
  RecordContourError(r);
  const bool waits =
      (r.state == MachineState::kIdle || r.state == MachineState::kReady) && !transitions_.run_pending();
  const bool over = r.state == MachineState::kFaulted && transitions_.drives_off();
  const bool lost = r.state == MachineState::kFaulted && transitions_.since() >= kFaultSettledCycles;
  out.quiescent = ((waits || over) && transitions_.since() >= kSettledCycles) || lost;
  out.settling = (waits || r.state == MachineState::kFaulted) && !out.quiescent;
  follower_.SearchStop();
}

void Cycle::RecordContourError(CycleRecord& record) noexcept {
  for (std::size_t i = 0; i < axis_count_; ++i) {
    near_position_m_[i] = axes_[i].position_m;
    follower_.Around(i, kLocalPathReach, near_path_[i]);
  }
  const ContourError error =
      FindContourError(near_position_m_, near_path_, period_s_, static_cast<std::size_t>(kLocalPathReach));
  record.contour_error_m = error.contour_m;
  record.lag_error_m = error.lag_m;
}

void Cycle::RecordAxis(std::size_t i, AxisRecord& r) noexcept {
  r.feedback = master_.feedback()[i];
  r.reference = AtSample(i);
  // What an experiment puts on belongs to the torque of this row, which begins to act one period later.
  r.reference.extra_torque_Nm = control_in_.reference[i][1].extra_torque_Nm;
  r.reference.spring_N_m = control_in_.reference[i][1].spring_N_m;
  r.estimate = estimates_[i];
  r.position_m = axes_[i].position_m;
  r.following_error_m = r.reference.position_m - r.position_m;
  r.feedforward_Nm = control_out_.feedforward_N[i] * axes_[i].radius_m_rad;
  r.wanted_torque_Nm = axes_[i].wanted_torque_Nm;
  r.torque_Nm = master_.sent_torque_Nm()[i];
  r.target_position_rad = setpoints_[i].position_rad;
  r.goal = setpoints_[i].goal;
  const bool held = transitions_.holds_torque();
  r.limit = guarded_[i].limit != Reason::kNone || !held ? guarded_[i].limit : control_out_.limit[i];
  const AxisDriveStatus& status = master_.status()[i];
  if (held && r.limit == Reason::kNone && status.emergency == EmergencyReaction::kWarn)
    r.limit = Reason::kEmergencyNoticed;
  if (held && r.limit == Reason::kNone) r.limit = watch_.Limit(i);
  if (r.limit == Reason::kNone && held && axes_[i].monitor.torque_constant_changed())
    r.limit = Reason::kTorqueConstantChanged;
  r.emergency_code = status.emergency_code;
  r.reference_state = master_.reference(i);
  if (IsReferenced(r.reference_state)) {
    r.travel_min_m = axes_[i].position_min_m;
    r.travel_max_m = axes_[i].position_max_m;
  } else if (held) {
    r.travel_min_m = guard_.allowed_min_m(i);
    r.travel_max_m = guard_.allowed_max_m(i);
  } else {
    r.travel_min_m = axes_[i].position_m - axes_[i].unreferenced_travel_m;
    r.travel_max_m = axes_[i].position_m + axes_[i].unreferenced_travel_m;
  }
}

}  // namespace contour
