#include "drivers/cia402/drive_master.h"

#include <algorithm>
#include <cmath>

#include "drivers/cia402/drive_state.h"
#include "drivers/cia402/pdo_layout.h"

namespace contour {
namespace {

constexpr std::uint32_t kFreshEnough_cycles = 5;  // feedback younger than this: the drive is there

}  // namespace

// Also when nobody could have heard it begin anew.
void DriveMaster::CountBeganAnew(std::size_t axis) noexcept {
  Axis& a = axes_[axis];
  if (a.absolute) return;
  DoubtPosition(axis);
  a.offset_rad = 0.0;
  a.seen_before = false;
}

// Where an axis is found that nobody saw meanwhile. One with an absolute encoder may have coasted; an encoder
// that was put on anew, or a zero that was moved, has the axis elsewhere. A drive may report anything until
// it has read its encoder, so each reading is looked at until the axis is enabled.
void DriveMaster::FindElsewhere(std::size_t axis, double found_rad) noexcept {
  Axis& a = axes_[axis];
  if (a.unseen_travel_rad <= 0.0) return;
  const double coasted_rad = a.absolute ? a.coast_cycles2_rad * a.last_step_rad * a.last_step_rad : 0.0;
  const bool elsewhere = std::abs(found_rad - a.last_seen_rad) > a.unseen_travel_rad + coasted_rad;
  if (a.absolute && elsewhere) {
    a.reference = ReferenceState::kLost;
  } else if (a.absolute && a.reference == ReferenceState::kLost) {
    a.reference = a.offset_rad == 0.0 ? ReferenceState::kAbsolute : ReferenceState::kTold;
  } else if (elsewhere) {
    CountBeganAnew(axis);
  }
}

void DriveMaster::DoubtPosition(std::size_t axis) noexcept {
  Axis& a = axes_[axis];
  const bool knew = a.reference == ReferenceState::kTold || a.was_enabled;
  if (!a.absolute && knew) a.reference = ReferenceState::kLost;
}

bool DriveMaster::CanTellPosition(std::size_t axis) const noexcept {
  return axis < axis_count_ && axes_[axis].reference != ReferenceState::kAbsolute && Healthy(axis) &&
         feedback_[axis].valid && feedback_[axis].fresh;
}

void DriveMaster::TellPosition(std::size_t axis, double position_rad) noexcept {
  axes_[axis].offset_rad += position_rad - feedback_[axis].position_rad;
  feedback_[axis].position_rad = position_rad;
  axes_[axis].reference = ReferenceState::kTold;
  axes_[axis].seen_before = false;
}

bool DriveMaster::Healthy(std::size_t axis) const noexcept {
  const AxisDriveStatus& s = status_[axis];
  return s.configured && !s.heartbeat_lost && !s.restarted && s.nmt == NmtState::kOperational;
}

bool DriveMaster::operational() const noexcept {
  for (std::size_t i = 0; i < axis_count_; ++i) {
    if (!Healthy(i)) return false;
  }
  return pdos_run_;
}

void DriveMaster::StartBringUp() noexcept {
  bool needed = !operational() || bring_up_failed();
  for (const AxisDriveStatus& s : status_)
    needed = needed || s.mode_changed || s.answers != AnswerFault::kNone;
  for (const AxisFeedback& f : feedback_) needed = needed || !f.valid || f.age_cycles > kFreshEnough_cycles;
  // Whoever asks for it has seen what the drives reported.
  for (std::size_t i = 0; i < axis_count_; ++i) {
    ForgetEmergency(i);
    status_[i].lost_master = false;
  }
  if (!needed || (BringingUp() && !bring_up_failed())) return;
  StopPdos();
  started_ = true;
  for (Bus& b : buses_) {
    b.bring_up.Start();
    b.patrol.Stop();
    b.usual_sync_ns = kNeverAnswered;
  }
  for (std::size_t i = 0; i < axis_count_; ++i) {
    if (!Heard(i)) CountBeganAnew(i);
    axes_[i].boot_up_due = false;
    if (feedback_[i].valid) {
      // An absolute encoder that is doubted is still held against where it was before.
      const bool doubted = axes_[i].seen_before && axes_[i].reference == ReferenceState::kLost;
      axes_[i].seen_before = axes_[i].absolute || (!status_[i].restarted && !status_[i].heartbeat_lost);
      if (!axes_[i].absolute || !doubted) axes_[i].last_seen_rad = feedback_[i].position_rad;
    }
    status_[i] = {};
    feedback_[i].valid = feedback_[i].fresh = feedback_[i].has_scale = feedback_[i].scale_fresh = false;
    feedback_[i].drive_state = DriveState::kUnknown;
    feedback_[i].age_cycles = 0;
    axes_[i].walk.Reset();
    axes_[i].earliest_answer_ns = axes_[i].usual_answer_ns = kNeverAnswered;
    axes_[i].behind = false;
    axes_[i].let_go_cycles = 0;
    axes_[i].unasked = 0;
    axes_[i].answered_sync = axes_[i].unasked_since = sync_number_;
    axes_[i].stays_seen_cycles = 0;
  }
}

std::uint8_t DriveMaster::second_master() const noexcept {
  for (std::size_t b = 0; b < buses_.size(); ++b)
    if (buses_[b].bring_up.second_master()) return static_cast<std::uint8_t>(b);
  return kNoBus;
}

bool DriveMaster::NewSecondMaster(const ReceivedFrames& frames) const noexcept {
  return std::any_of(frames.begin(), frames.end(), [&](const StampedFrame& f) {
    return f.bus < buses_.size() && buses_[f.bus].bring_up.NewSecondMaster(f.frame);
  });
}

void DriveMaster::FallSilent() noexcept {
  StopPdos();
  started_ = false;
  for (Bus& b : buses_) b.patrol.Stop();
}

BringUpStatus DriveMaster::bring_up() const noexcept {
  const BringUp* shown = &buses_.front().bring_up;
  for (const Bus& b : buses_) {
    const BringUp& other = b.bring_up;
    const bool failed_first = other.failed() && !shown->failed();
    const bool behind = other.failed() == shown->failed() && ComesBefore(other.phase(), shown->phase());
    if (failed_first || behind) shown = &other;
  }
  return shown->status();
}

bool DriveMaster::busy() const noexcept {
  if (BringingUp()) return true;
  if (!pdos_run_) return false;
  for (std::size_t i = 0; i < axis_count_; ++i) {
    const AxisDriveStatus& s = status_[i];
    const bool resting_in_fault =
        feedback_[i].drive_state == DriveState::kFault && goal_[i] != DriveGoal::kFaultReset;
    if (!s.at_goal && !s.transition_late && !s.left_enabled && !resting_in_fault) return true;
  }
  return false;
}

bool DriveMaster::BringingUp() const noexcept {
  return std::any_of(buses_.begin(), buses_.end(), [](const Bus& b) { return b.bring_up.running(); });
}

void DriveMaster::StopPdos() noexcept {
  pdos_run_ = sync_sent_ = settled_ = false;
  probe_.Reset();
}

// Whether there are PDOs and SYNC in the next cycle, until it is known which SYNC each drive answers.
void DriveMaster::Settle() noexcept {
  if (!pdos_run_ && !probe_.leaves_out()) return StartPdos();
  sync_sent_ = pdos_run_;
  AnswerProbe::Axes answered;
  bool all = true;
  for (std::size_t i = 0; i < axis_count_; ++i) {
    answered[i] = feedback_[i].valid && axes_[i].answer_cycle == cycle_;
    all = all && feedback_[i].valid;
  }
  const AnswerProbe::Axes late = probe_.Step(answered, elapsed_);
  for (std::size_t i = 0; i < axis_count_; ++i)
    if (late[i]) status_[i].answers = AnswerFault::kLate;
  pdos_run_ = !probe_.leaves_out();
  settled_ = all && !probe_.running();
}

// The cycle after the last drive came up is the first with PDOs and SYNC.
void DriveMaster::StartPdos() noexcept {
  if (!std::all_of(buses_.begin(), buses_.end(), [](const Bus& b) { return b.bring_up.done(); })) return;
  pdos_run_ = true;
  for (Bus& b : buses_) b.patrol.Start();
  for (std::size_t i = 0; i < axis_count_; ++i) {
    status_[i].configured = true;
    status_[i].nmt = NmtState::kOperational;
    // While it was brought up there was no SYNC and no set-point, and it may have said so.
    status_[i].lost_master = false;
    if ((status_[i].emergency_cause & 0xF000) == 0x8000) ForgetEmergency(i);
    axes_[i].alive_cycle = cycle_;
    axes_[i].boot_up_due = false;
  }
}

CanFrame DriveMaster::SetpointFrame(std::size_t axis, const AxisSetpoint& setpoint) noexcept {
  Axis& a = axes_[axis];
  AxisDriveStatus& s = status_[axis];
  const AxisFeedback& f = feedback_[axis];

  const std::uint16_t word = a.walk.Step(f.drive_state, setpoint.goal, elapsed_);
  goal_[axis] = setpoint.goal;
  a.let_go_cycles = setpoint.goal == DriveGoal::kEnabled ? 0 : a.let_go_cycles + elapsed_;
  s.at_goal = a.walk.at_goal();
  s.transition_late = a.walk.late();
  s.stuck_in = a.walk.stuck_in();
  s.in_state_cycles = a.walk.in_state_cycles();
  s.goal = setpoint.goal;
  s.left_enabled = a.walk.left_enabled();

  const bool follows = setpoint.goal == DriveGoal::kEnabled && f.drive_state == DriveState::kOperationEnabled;
  std::int16_t torque = 0;
  if (follows) {
    torque = a.rounding.Round(a.torque, setpoint.torque_Nm, a.torque_limit_Nm, setpoint.in_motion);
  } else {
    a.rounding.Reset();
  }
  sent_torque_Nm_[axis] = a.torque.FromPerMille(torque);
  if (a.mode == DriveMode::kCst) return EncodeTorqueSetpoint(a.node_id, word, torque);

  // A drive that does not follow is told to be where it is, so that enabling it finds no step.
  const double target_rad =
      follows && std::isfinite(setpoint.position_rad) ? setpoint.position_rad : f.position_rad;
  return EncodePositionSetpoint(a.node_id, word, a.position.ToCounts(target_rad - a.offset_rad),
                                a.torque_offset, torque);
}

// Of two controlwords before one SYNC the drive acts upon the last, and ours may never be that. A stopped
// node takes no PDO at all, and by its abort connection option (0x6007, CiA 402) it leaves Operation Enabled;
// only the next bring-up wakes it. Asked for again as long as it goes on answering: the other may start it
// anew. The same is the last resort with a drive that ignores its controlword, whoever else is there.
bool DriveMaster::IgnoresUs(std::size_t axis) const noexcept {
  const Axis& a = axes_[axis];
  const AxisFeedback& f = feedback_[axis];
  if (status_[axis].stays_enabled) return true;
  return buses_[a.bus].bring_up.second_master() && a.let_go_cycles > a.obeys_cycles && f.fresh &&
         f.drive_state == DriveState::kOperationEnabled;
}

void DriveMaster::Send(const PerAxis<AxisSetpoint>& setpoints, Frames& out) noexcept {
  const bool pdos = pdos_run_;
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    Bus& bus = buses_[b];
    const auto index = static_cast<std::uint8_t>(b);
    if (pdos) {
      for (std::size_t i = 0; i < axis_count_; ++i) {
        if (axes_[i].bus != b) continue;
        const AxisSetpoint setpoint = i < setpoints.size() ? setpoints[i] : AxisSetpoint{};
        out.push_back({SetpointFrame(i, setpoint), index, 0});
      }
      for (std::size_t i = 0; i < axis_count_; ++i)
        if (axes_[i].bus == b && IgnoresUs(i))
          out.push_back({NmtFrame(NmtCommand::kStop, axes_[i].node_id), index, 0});
      out.push_back({SyncFrame(), index, 0});
    }
    BringUp::Frames frames;
    const bool waits = bus.bring_up.phase() == BringUpPhase::kBootUp;
    bus.bring_up.Step(elapsed_, frames);
    if (!waits && bus.bring_up.phase() == BringUpPhase::kBootUp)
      for (Axis& a : axes_) a.boot_up_due = a.boot_up_due || a.bus == b;
    bus.patrol.Step(elapsed_, frames);
    for (const CanFrame& f : frames) out.push_back({f, index, 0});
    if (HeartbeatRuns(b) && cycle_ >= bus.heartbeat_due) {
      out.push_back({HeartbeatFrame(bus.master_node_id, NmtState::kOperational), index, 0});
      bus.heartbeat_due = cycle_ + bus.heartbeat_cycles;
    }
  }
  if (pdos) {
    sync_sent_ = true;
    ++sync_number_;
    sync_grid_ns_ = grid_ns_;
  }
  if (!settled_) Settle();
}

}  // namespace contour
