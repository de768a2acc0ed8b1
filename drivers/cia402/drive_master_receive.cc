#include <algorithm>
#include <cmath>

#include "drivers/cia402/drive_master.h"
#include "drivers/cia402/drive_state.h"
#include "drivers/cia402/pdo_layout.h"

// What the drives send, and what it says of them.
namespace contour {
namespace {

// By which the median of a drive's answers moves at each: half a bit at 1 Mbit/s, little beside stuff bits. A
// load of the bus that stays is usual within some 100 ms.
constexpr std::int64_t kUsualStep_ns = 500;
constexpr std::int64_t kSameClock_periods = 1000;  // stamps further away from the grid are not of its clock
// Of an answer that comes while no SYNC is unanswered nobody was asked. Half as many as SYNCs are those of
// another drive; answers of one that were held up, for however long, are owed.
constexpr std::uint64_t kUnaskedOver_syncs = 16;
constexpr std::uint32_t kUnaskedOfTwo = kUnaskedOver_syncs / 2;

}  // namespace

void DriveMaster::Receive(const CycleInput& in) noexcept {
  // The number of the grid point is the clock: a skipped point counts as time gone by.
  elapsed_ = seen_cycle_ && in.cycle > cycle_ ? in.cycle - cycle_ : 1;
  cycle_ = in.cycle;
  grid_ns_ = in.grid_time_ns;
  seen_cycle_ = true;

  for (AxisFeedback& f : feedback_) f.fresh = f.scale_fresh = false;
  for (const StampedFrame& frame : in.frames) OnFrame(frame);
  for (std::size_t b = 0; b < buses_.size() && b < in.buses.size(); ++b) {
    if (in.buses[b].up && !in.buses[b].bus_off) continue;
    buses_[b].bring_up.BusDown();
    // Nobody would hear a boot-up message now.
    for (std::size_t i = 0; i < axis_count_; ++i)
      if (axes_[i].bus == b) CountBeganAnew(i);
  }
  for (std::size_t i = 0; i < axis_count_; ++i) Supervise(i);
}

void DriveMaster::OnFrame(const StampedFrame& stamped) noexcept {
  if (stamped.bus >= buses_.size()) return;
  const CanFrame& frame = stamped.frame;
  if (frame.id == cob::kOwnSync) return OnOwnSync(buses_[stamped.bus], stamped.stamp_ns);
  buses_[stamped.bus].bring_up.OnFrame(frame);
  buses_[stamped.bus].patrol.OnFrame(frame);

  const std::size_t axis = axis_of_node_[stamped.bus * kNodes + (frame.id & 0x7F)];
  if (axis == kNoAxis) return;
  switch (frame.id & 0x780) {
    case cob::kEmergency:
      if (frame.length >= 3) OnEmergency(axis, frame);
      return;
    case cob::kTpdo1:
      if (frame.length >= kFeedbackLength) OnFeedback(axis, stamped);
      return;
    case cob::kTpdo1 + 0x100:
      if (axes_[axis].has_scale && frame.length >= kScaleLength && status_[axis].configured) {
        AxisFeedback& f = feedback_[axis];
        f.table_position_m = static_cast<double>(axes_[axis].scale_unwrap.Update(DecodeScale(frame))) *
                             axes_[axis].scale_m_per_count;
        f.has_scale = f.scale_fresh = true;
      }
      return;
    case cob::kHeartbeat:
      if (frame.length >= 1) OnHeartbeat(axis, frame);
      return;
    default:
      return;
  }
}

void DriveMaster::OnHeartbeat(std::size_t axis, const CanFrame& frame) noexcept {
  AxisDriveStatus& s = status_[axis];
  s.nmt = HeartbeatState(frame);
  if (!Heard(axis) && !buses_[axes_[axis].bus].bring_up.running()) CountBeganAnew(axis);
  axes_[axis].alive_cycle = cycle_;
  if (s.nmt == NmtState::kBootUp) {
    s.restarted = s.restarted || s.configured;
    s.emergency_code = 0;
    ForgetEmergency(axis);
    if (!axes_[axis].boot_up_due) CountBeganAnew(axis);
    axes_[axis].boot_up_due = false;
  }
}

void DriveMaster::OnEmergency(std::size_t axis, const CanFrame& frame) noexcept {
  AxisDriveStatus& s = status_[axis];
  Axis& a = axes_[axis];
  const Emergency e = DecodeEmergency(frame);
  s.emergency_code = e.error_code;
  if (e.error_code == 0) {
    // With bits left in the register only one of several errors is gone.
    if (e.error_register == 0) ForgetEmergency(axis);
    return;
  }
  if (patrols_) buses_[a.bus].patrol.ReadErrors(a.patrolled);
  EmergencyReaction reaction = ReactionTo(e);
  for (const StrongerReaction& r : a.stronger)
    if (r.codes.Holds(e.error_code)) reaction = std::max(reaction, r.reaction);
  s.lost_master = s.lost_master || SaysMasterLost(e.error_code);
  if (reaction <= a.reported) return;
  a.reported = reaction;
  a.reported_cycle = cycle_;
  s.emergency_cause = e.error_code;
}

void DriveMaster::ForgetEmergency(std::size_t axis) noexcept {
  axes_[axis].reported = EmergencyReaction::kNone;
  status_[axis].emergency = EmergencyReaction::kNone;
  status_[axis].emergency_cause = 0;
}

// A drive answers each SYNC, in their order, and an answer that misses its grid point has the look of one to
// the next SYNC. What tells them apart after an answer was missed is the time: nobody answers a SYNC much
// sooner than ever before. From then on the drive is one answer behind, until two come in one cycle. Stamps
// of another clock (lock-step) are never this close to the grid.
bool DriveMaster::AnswersNewestSync(Axis& axis, const AxisFeedback& feedback,
                                    std::int64_t stamp_ns) const noexcept {
  const bool second = feedback.valid && axis.answer_cycle == cycle_;
  const bool next = axis.answer_cycle + elapsed_ == cycle_;
  axis.answer_cycle = cycle_;
  if (second || !feedback.valid) {
    axis.behind = false;
    return true;
  }
  const std::int64_t after_ns = stamp_ns - sync_grid_ns_;
  if (feedback.age_cycles == 0) {
    if (after_ns > 0) axis.earliest_answer_ns = std::min(axis.earliest_answer_ns, after_ns);
    return true;
  }
  const bool same_clock =
      axis.earliest_answer_ns <= period_ns_ && after_ns > -kSameClock_periods * period_ns_;
  const bool too_soon = same_clock && after_ns < axis.earliest_answer_ns - axis.earliest_answer_ns / 4;
  axis.behind = too_soon || (axis.behind && next);
  return !axis.behind;
}

// Usual is the median of late: it takes steps of one size, so a few that come late or early hardly move it.
double DriveMaster::Late_s(std::int64_t& usual_ns, std::int64_t stamp_ns) const noexcept {
  const std::int64_t after_ns = stamp_ns - sync_grid_ns_;
  if (usual_ns == kNeverAnswered) usual_ns = after_ns;
  const std::int64_t late_ns = after_ns - usual_ns;
  usual_ns += std::clamp(late_ns, -kUsualStep_ns, kUsualStep_ns);
  return 1e-9 * static_cast<double>(late_ns);
}

void DriveMaster::OnOwnSync(Bus& bus, std::int64_t stamp_ns) noexcept {
  if (!AfterSync(stamp_ns)) return;
  const double before_s = bus.sync_told_cycle + elapsed_ == cycle_ ? bus.sync_late_s : 0.0;
  bus.sync_late_s = Late_s(bus.usual_sync_ns, stamp_ns);
  bus.sync_apart_s = bus.sync_late_s - before_s;
  bus.sync_told_cycle = cycle_;
}

// A SYNC waits for a frame that is on the bus already, and a little longer or shorter for the stuff bits of
// our own frames before it; the answer to it, and what is read, are late by as much. Where the bus does not
// tell when the SYNC was on the wire, the answer alone is to go by, which other frames hold up as well.
void DriveMaster::TellLateness(std::size_t axis, std::int64_t stamp_ns) noexcept {
  Axis& a = axes_[axis];
  AxisFeedback& f = feedback_[axis];
  const Bus& bus = buses_[a.bus];
  if (!f.fresh || !AfterSync(stamp_ns)) {
    f.late_s = f.sync_late_s = 0.0;
    return;
  }
  f.sync_late_s = bus.sync_told_cycle == cycle_ ? bus.sync_late_s : 0.0;
  f.late_s = Late_s(a.usual_answer_ns, stamp_ns) - f.sync_late_s;
}

void DriveMaster::OnFeedback(std::size_t axis, const StampedFrame& stamped) noexcept {
  // Before the drive is configured its TPDO may hold anything.
  if (!status_[axis].configured) return;
  const RawFeedback raw = DecodeFeedback(stamped.frame);
  AxisFeedback& f = feedback_[axis];
  Axis& a = axes_[axis];
  const bool newest = AnswersNewestSync(a, f, stamped.stamp_ns);
  const double counted_rad = a.position.ToRad(a.unwrap.Update(raw.position_counts));
  if (a.seen_before) FindElsewhere(axis, counted_rad + a.offset_rad);
  CountAnswer(a, axis, f.valid);
  if (!a.absolute) a.seen_before = false;
  const double now_rad = counted_rad + a.offset_rad;
  if (a.absolute && f.valid && !f.fresh && !a.seen_before) {
    a.last_step_rad = now_rad - f.position_rad;
    if (f.age_cycles > 0) a.last_step_rad /= static_cast<double>(1 + f.age_cycles);
  }
  f.position_rad = now_rad;
  f.torque_Nm = a.torque.FromPerMille(raw.torque_per_mille);
  f.statusword = raw.statusword;
  f.drive_state = DecodeStatusword(raw.statusword);
  const bool enabled = f.drive_state == DriveState::kOperationEnabled;
  a.was_enabled = a.was_enabled || enabled;
  a.seen_before = a.seen_before && !enabled;
  f.fresh = newest;
  f.valid = true;
  if (newest) f.age_cycles = 0;
  if (a.mode == DriveMode::kCst) TellLateness(axis, stamped.stamp_ns);
  a.alive_cycle = cycle_;  // it answers every SYNC: a sign of life at least as good as its heartbeat
  feedback_sync_ = std::max(feedback_sync_, newest ? sync_number_ : sync_number_ - 1);
}

// SYNCs before its first answer are no debts of it; whether they were answered late is asked where it was not
// the first SYNC that this one came right behind.
void DriveMaster::CountAnswer(Axis& a, std::size_t index, bool answered_before) noexcept {
  if (!answered_before) {
    if (probes_ && (sync_number_ - a.answered_sync > 1 || elapsed_ > 1)) probe_.Doubt(index);
    a.answered_sync = sync_number_;
  } else if (a.answered_sync < sync_number_) {
    ++a.answered_sync;
  } else {
    ++a.unasked;
  }
}

// What it owes for longer than its heartbeat may be missing it has lost.
void DriveMaster::WatchAnswers(std::size_t axis) noexcept {
  Axis& a = axes_[axis];
  if (sync_number_ - a.unasked_since < kUnaskedOver_syncs) return;
  if (sync_number_ - a.answered_sync > a.heartbeat_timeout_cycles)
    a.answered_sync = sync_number_ - a.heartbeat_timeout_cycles;
  AxisDriveStatus& s = status_[axis];
  if (s.configured && patrols_ && a.unasked >= kUnaskedOfTwo) s.answers = AnswerFault::kTwice;
  a.unasked = 0;
  a.unasked_since = sync_number_;
}

// Told to leave it, and there for as long after its time as a statusword takes to show a controlword.
void DriveMaster::WatchStaying(std::size_t axis) noexcept {
  Axis& a = axes_[axis];
  const AxisFeedback& f = feedback_[axis];
  AxisDriveStatus& s = status_[axis];
  s.stays_enabled = false;
  if (a.let_go_cycles <= a.stays_cycles || f.drive_state != DriveState::kOperationEnabled || !patrols_ ||
      !pdos_run_) {
    a.stays_seen_cycles = 0;
    return;
  }
  if (!f.fresh) return;
  a.stays_seen_cycles += elapsed_;
  s.stays_enabled = a.stays_seen_cycles > a.obeys_cycles;
}

void DriveMaster::Supervise(std::size_t axis) noexcept {
  AxisFeedback& f = feedback_[axis];
  AxisDriveStatus& s = status_[axis];
  if (!f.fresh) f.age_cycles += static_cast<std::uint32_t>(elapsed_);
  const bool fault = f.valid && IsFaultState(f.drive_state);
  if (patrols_) {
    DrivePatrol& patrol = buses_[axes_[axis].bus].patrol;
    if (fault && !s.fault) patrol.ReadErrors(axes_[axis].patrolled);
    s.mode_changed = pdos_run_ && patrol.mode_changed(axes_[axis].patrolled);
  }
  s.fault = fault;
  if (cycle_ != axes_[axis].reported_cycle) s.emergency = axes_[axis].reported;
  s.silent_cycles = cycle_ - axes_[axis].alive_cycle;
  WatchFollowing(axis);
  WatchAnswers(axis);
  WatchStaying(axis);
  if (s.configured && cycle_ - axes_[axis].alive_cycle >= axes_[axis].heartbeat_timeout_cycles) {
    if (!s.heartbeat_lost) CountBeganAnew(axis);
    s.heartbeat_lost = true;
    s.nmt = NmtState::kUnknown;
  }
}

// A statusword that shows Operation Enabled for the first time was latched before any set-point was sent, and
// so was the next one; the drive may take `delay_cycles` to act upon a set-point. Not every drive has bit 9;
// one that has shown it and does not any more obeys another: a panel, or a maker's program. A drive whose
// bits are not these is configured so.
void DriveMaster::WatchFollowing(std::size_t axis) noexcept {
  Axis& a = axes_[axis];
  const AxisFeedback& f = feedback_[axis];
  const bool told = goal_[axis] == DriveGoal::kEnabled && f.drive_state == DriveState::kOperationEnabled;
  const std::uint16_t may_show = a.follow_bits != 0 ? statusword::kRemote : std::uint16_t{0};
  a.shown_bits = told ? a.shown_bits | (f.statusword & may_show) : a.follow_bits;
  if (!told || (a.shown_bits & ~f.statusword) == 0) {
    a.not_following_cycles = 0;
  } else if (f.fresh) {
    a.not_following_cycles += elapsed_;
  }
  status_[axis].not_following = a.not_following_cycles > a.follow_cycles;
}

bool DriveMaster::Heard(std::size_t axis) const noexcept {
  const Axis& a = axes_[axis];
  return a.alive_cycle == 0 || cycle_ - a.alive_cycle < a.heartbeat_timeout_cycles;
}

}  // namespace contour
