#include "drivers/cia402/drive_master.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "drivers/cia402/drive_script.h"
#include "drivers/cia402/drive_state.h"
#include "drivers/cia402/pdo_layout.h"

namespace contour {
namespace {

constexpr std::uint8_t kNoAxis = 0xFF;
constexpr std::size_t kNodes = 128;
constexpr std::uint32_t kFreshEnough_cycles = 5;   // feedback younger than this: the drive is there
constexpr std::int64_t kSameClock_periods = 1000;  // stamps further away from the grid are not of its clock

[[noreturn]] void Refuse(const AxisDriveConfig& axis, const std::string& what) {
  throw std::invalid_argument("axis " + axis.name + ": " + what);
}

void Check(const AxisDriveConfig& axis, const MasterConfig& config) {
  const DriveConfig& d = axis.drive;
  if (axis.bus >= config.buses.size()) Refuse(axis, "the drive's bus does not exist");
  if (d.node_id < 1 || d.node_id > 127) Refuse(axis, "node_id must be 1 to 127");
  if (d.node_id == config.buses[axis.bus].master_node_id) {
    Refuse(axis, "node_id " + std::to_string(d.node_id) + " is the master's own (master_node_id)");
  }
  if (!(d.rated_torque_Nm > 0.0)) Refuse(axis, "rated_torque_Nm must be greater than 0");
  if (d.encoder_counts_per_rev == 0) Refuse(axis, "encoder_counts_per_rev must not be 0");
  if (!(axis.torque_limit_Nm > 0.0)) Refuse(axis, "the torque limit must be greater than 0");
  if (axis.torque_limit_Nm > d.peak_torque_Nm) {
    Refuse(axis, "the torque limit of " + std::to_string(axis.torque_limit_Nm) +
                     " Nm exceeds peak_torque_Nm " + std::to_string(d.peak_torque_Nm));
  }
  if (axis.torque_limit_Nm > 32.0 * d.rated_torque_Nm) {
    Refuse(axis, "the torque limit is more than 32 times rated_torque_Nm, which 0x6071 cannot carry");
  }
  if (!(d.heartbeat_timeout_ms > d.heartbeat_ms)) {
    Refuse(axis, "heartbeat_timeout_ms must be longer than heartbeat_ms");
  }
  if (d.notice_ms * 1000.0 < 2.0 * config.cycle_us) {
    Refuse(axis,
           "notice_ms must be at least two cycles, or the drive stops between two frames of the master");
  }
}

void CheckNodes(const MasterConfig& config) {
  for (std::size_t i = 0; i < config.axes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const AxisDriveConfig& a = config.axes[j];
      const AxisDriveConfig& b = config.axes[i];
      if (a.bus == b.bus && a.drive.node_id == b.drive.node_id) {
        Refuse(b, "node_id " + std::to_string(b.drive.node_id) + " is already that of axis " + a.name);
      }
    }
  }
}

}  // namespace

DriveMaster::DriveMaster(const MasterConfig& config)
    : feedback_(config.axes.size()),
      status_(config.axes.size()),
      sent_torque_Nm_(config.axes.size()),
      axis_of_node_(config.buses.size() * kNodes, kNoAxis),
      period_ns_(std::int64_t{config.cycle_us} * 1000),
      patrols_(config.start_up != StartUp::kOfLogFormat4) {
  if (config.axes.empty() || config.axes.size() > kMaxAxes) {
    throw std::invalid_argument("a machine has 1 to " + std::to_string(kMaxAxes) + " axes");
  }
  if (config.buses.empty() || config.buses.size() > kMaxBuses) {
    throw std::invalid_argument("a machine has 1 to " + std::to_string(kMaxBuses) + " buses");
  }
  CheckNodes(config);

  std::vector<std::vector<BringUpNode>> nodes(config.buses.size());
  std::vector<std::vector<PatrolledDrive>> patrols(config.buses.size());
  std::vector<std::uint64_t> heartbeat_cycles(config.buses.size(), ~std::uint64_t{0});
  for (std::size_t i = 0; i < config.axes.size(); ++i) {
    const AxisDriveConfig& a = config.axes[i];
    Check(a, config);
    const DriveConfig& d = a.drive;
    nodes[a.bus].push_back(DriveScript(d, static_cast<std::uint8_t>(i), a.torque_limit_Nm,
                                       config.buses[a.bus].master_node_id, config.cycle_us,
                                       config.start_up != StartUp::kOfLogFormat4));
    heartbeat_cycles[a.bus] =
        std::min(heartbeat_cycles[a.bus], MasterHeartbeatCycles(d.notice_ms, config.cycle_us));
    axis_of_node_[a.bus * kNodes + static_cast<std::size_t>(d.node_id)] = static_cast<std::uint8_t>(i);

    Axis axis;
    axis.bus = a.bus;
    axis.node_id = static_cast<std::uint8_t>(d.node_id);
    axis.mode = d.mode;
    axis.torque_offset = d.csp_torque_offset;
    axis.has_scale = d.linear_scale.has_value();
    axis.torque = {d.rated_torque_Nm};
    axis.position = {static_cast<double>(d.encoder_counts_per_rev)};
    axis.scale_m_per_count = d.linear_scale ? 1e-3 / d.linear_scale->counts_per_mm : 0.0;
    axis.torque_limit_Nm = a.torque_limit_Nm;
    axis.walk =
        DriveWalk(CyclesOf(d.transition_ms, config.cycle_us), CyclesOf(d.quick_stop_ms, config.cycle_us));
    for (const auto& [codes, reaction] : d.emergency_reaction) {
      const std::optional<EmergencyClass> parsed = ParseEmergencyClass(codes);
      if (!parsed) Refuse(a, "emergency_reaction: '" + codes + "' is no error code such as 0x4210 or 0x42xx");
      axis.stronger.push_back({*parsed, reaction});
    }
    axis.patrolled = patrols[a.bus].size();
    patrols[a.bus].push_back({axis.node_id, ModeOfOperation(d.mode), CyclesOf(d.sdo_ms, config.cycle_us)});
    if (d.follows_target_bit) axis.follow_cycles = 2 + static_cast<std::uint64_t>(d.delay_cycles);
    axis.heartbeat_timeout_cycles = CyclesOf(d.heartbeat_timeout_ms, config.cycle_us);
    if (!d.absolute_encoder && config.start_up != StartUp::kOfLogFormat4)
      axis.reference = ReferenceState::kNeverTold;
    axis.unseen_travel_rad = a.unseen_travel_rad;
    axes_.push_back(axis);
  }
  for (std::size_t b = 0; b < config.buses.size(); ++b) {
    Bus bus;
    if (config.start_up != StartUp::kOfLogFormat4)
      bus.patrol = DrivePatrol(std::move(patrols[b]), config.cycle_us);
    bus.master_node_id = static_cast<std::uint8_t>(config.buses[b].master_node_id);
    const double listen_ms = config.start_up == StartUp::kOfLogFormat4 ? 0.0 : config.buses[b].listen_ms;
    bus.bring_up = BringUp(std::move(nodes[b]), config.cycle_us,
                           {static_cast<std::uint8_t>(b), bus.master_node_id,
                            listen_ms > 0.0 ? CyclesOf(listen_ms, config.cycle_us) : 0});
    bus.heartbeat_cycles = heartbeat_cycles[b];
    buses_.push_back(std::move(bus));
  }
}

void DriveMaster::Receive(const CycleInput& in) noexcept {
  // The number of the grid point is the clock: a skipped point counts as time gone by.
  elapsed_ = seen_cycle_ && in.cycle > cycle_ ? in.cycle - cycle_ : 1;
  cycle_ = in.cycle;
  grid_ns_ = in.grid_time_ns;
  seen_cycle_ = true;

  for (AxisFeedback& f : feedback_) f.fresh = false;
  for (const StampedFrame& frame : in.frames) OnFrame(frame);
  for (std::size_t b = 0; b < buses_.size() && b < in.buses.size(); ++b) {
    if (in.buses[b].up && !in.buses[b].bus_off) continue;
    buses_[b].bring_up.BusDown();
    // Nobody would hear a boot-up message now.
    for (std::size_t i = 0; i < axes_.size(); ++i)
      if (axes_[i].bus == b) CountBeganAnew(i);
  }
  for (std::size_t i = 0; i < axes_.size(); ++i) Supervise(i);
}

void DriveMaster::OnFrame(const StampedFrame& stamped) noexcept {
  if (stamped.bus >= buses_.size()) return;
  const CanFrame& frame = stamped.frame;
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
        f.has_scale = true;
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

// Also when nobody could have heard it begin anew.
void DriveMaster::CountBeganAnew(std::size_t axis) noexcept {
  Axis& a = axes_[axis];
  DoubtPosition(axis);
  if (a.reference != ReferenceState::kAbsolute) a.offset_rad = 0.0;
  a.seen_before = false;
}

void DriveMaster::DoubtPosition(std::size_t axis) noexcept {
  Axis& a = axes_[axis];
  const bool knew = a.reference == ReferenceState::kTold || a.was_enabled;
  if (a.reference != ReferenceState::kAbsolute && knew) a.reference = ReferenceState::kLost;
}

bool DriveMaster::Heard(std::size_t axis) const noexcept {
  const Axis& a = axes_[axis];
  return a.alive_cycle == 0 || cycle_ - a.alive_cycle < a.heartbeat_timeout_cycles;
}

bool DriveMaster::CanTellPosition(std::size_t axis) const noexcept {
  return axis < axes_.size() && axes_[axis].reference != ReferenceState::kAbsolute && Healthy(axis) &&
         feedback_[axis].valid && feedback_[axis].fresh;
}

void DriveMaster::TellPosition(std::size_t axis, double position_rad) noexcept {
  axes_[axis].offset_rad += position_rad - feedback_[axis].position_rad;
  feedback_[axis].position_rad = position_rad;
  axes_[axis].reference = ReferenceState::kTold;
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

void DriveMaster::OnFeedback(std::size_t axis, const StampedFrame& stamped) noexcept {
  // Before the drive is configured its TPDO may hold anything.
  if (!status_[axis].configured) return;
  const RawFeedback raw = DecodeFeedback(stamped.frame);
  AxisFeedback& f = feedback_[axis];
  Axis& a = axes_[axis];
  const bool newest = AnswersNewestSync(a, f, stamped.stamp_ns);
  const double counted_rad = a.position.ToRad(a.unwrap.Update(raw.position_counts));
  const double moved_rad = std::abs(counted_rad + a.offset_rad - a.last_seen_rad);
  if (a.seen_before && a.unseen_travel_rad > 0.0 && moved_rad > a.unseen_travel_rad) CountBeganAnew(axis);
  a.seen_before = false;
  f.position_rad = counted_rad + a.offset_rad;
  f.torque_Nm = a.torque.FromPerMille(raw.torque_per_mille);
  f.statusword = raw.statusword;
  f.drive_state = DecodeStatusword(raw.statusword);
  a.was_enabled = a.was_enabled || f.drive_state == DriveState::kOperationEnabled;
  f.fresh = newest;
  f.valid = true;
  if (newest) f.age_cycles = 0;
  a.alive_cycle = cycle_;  // it answers every SYNC: a sign of life at least as good as its heartbeat
  feedback_sync_ = std::max(feedback_sync_, newest ? sync_number_ : sync_number_ - 1);
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
  if (s.configured && cycle_ - axes_[axis].alive_cycle >= axes_[axis].heartbeat_timeout_cycles) {
    if (!s.heartbeat_lost) CountBeganAnew(axis);
    s.heartbeat_lost = true;
    s.nmt = NmtState::kUnknown;
  }
}

// A statusword that shows Operation Enabled for the first time was latched before any set-point was sent, and
// so was the next one; the drive may take `delay_cycles` to act upon a set-point.
void DriveMaster::WatchFollowing(std::size_t axis) noexcept {
  Axis& a = axes_[axis];
  const AxisFeedback& f = feedback_[axis];
  const bool told = goal_[axis] == DriveGoal::kEnabled && f.drive_state == DriveState::kOperationEnabled;
  if (!told || FollowsTarget(f.statusword)) {
    a.not_following_cycles = 0;
  } else if (f.fresh) {
    a.not_following_cycles += elapsed_;
  }
  status_[axis].not_following = a.follow_cycles != 0 && a.not_following_cycles > a.follow_cycles;
}

bool DriveMaster::Healthy(std::size_t axis) const noexcept {
  const AxisDriveStatus& s = status_[axis];
  return s.configured && !s.heartbeat_lost && !s.restarted && s.nmt == NmtState::kOperational;
}

bool DriveMaster::operational() const noexcept {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (!Healthy(i)) return false;
  }
  return pdos_run_;
}

void DriveMaster::StartBringUp() noexcept {
  bool needed = !operational() || bring_up_failed();
  for (const AxisDriveStatus& s : status_) needed = needed || s.mode_changed;
  for (const AxisFeedback& f : feedback_) needed = needed || !f.valid || f.age_cycles > kFreshEnough_cycles;
  // Whoever asks for it has seen what the drives reported.
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    ForgetEmergency(i);
    status_[i].lost_master = false;
  }
  if (!needed || (BringingUp() && !bring_up_failed())) return;
  pdos_run_ = false;
  sync_sent_ = false;
  started_ = true;
  for (Bus& b : buses_) {
    b.bring_up.Start();
    b.patrol.Stop();
  }
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (!Heard(i)) CountBeganAnew(i);
    axes_[i].boot_up_due = false;
    if (feedback_[i].valid) {
      axes_[i].seen_before = !status_[i].restarted && !status_[i].heartbeat_lost;
      axes_[i].last_seen_rad = feedback_[i].position_rad;
    }
    status_[i] = {};
    feedback_[i].valid = feedback_[i].fresh = feedback_[i].has_scale = false;
    feedback_[i].drive_state = DriveState::kUnknown;
    feedback_[i].age_cycles = 0;
    axes_[i].walk.Reset();
    axes_[i].earliest_answer_ns = kNeverAnswered;
    axes_[i].behind = false;
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
  pdos_run_ = false;
  sync_sent_ = false;
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
  for (std::size_t i = 0; i < axes_.size(); ++i) {
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

// The cycle after the last drive came up is the first with PDOs and SYNC.
void DriveMaster::StartPdos() noexcept {
  if (pdos_run_) return;
  if (!std::all_of(buses_.begin(), buses_.end(), [](const Bus& b) { return b.bring_up.done(); })) return;
  pdos_run_ = true;
  for (Bus& b : buses_) b.patrol.Start();
  for (std::size_t i = 0; i < axes_.size(); ++i) {
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

void DriveMaster::Send(const PerAxis<AxisSetpoint>& setpoints, Frames& out) noexcept {
  const bool pdos = pdos_run_;
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    Bus& bus = buses_[b];
    const auto index = static_cast<std::uint8_t>(b);
    if (pdos) {
      for (std::size_t i = 0; i < axes_.size(); ++i) {
        if (axes_[i].bus != b) continue;
        const AxisSetpoint setpoint = i < setpoints.size() ? setpoints[i] : AxisSetpoint{};
        out.push_back({SetpointFrame(i, setpoint), index, 0});
      }
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
  StartPdos();
}

}  // namespace contour
