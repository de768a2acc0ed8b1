#include "daemon/rt/cycle.h"

#include <algorithm>
#include <cmath>

#include "control/contour_error.h"
#include "daemon/rt/cycle_parts.h"
#include "drivers/cia301/messages.h"

namespace contour {
namespace {

/// A program begins where the axes stand; more than this away and it is refused.
constexpr double kPathStartTolerance_m = 1e-6;
/// Lock-step time may stand still when nothing has changed for so many cycles.
constexpr std::uint32_t kSettledCycles = 300;
/// The same after a fault whose end cannot be seen, because the drives are out of reach.
constexpr std::uint32_t kFaultSettledCycles = 3000;
/// Reference points to either side of the feedback's instant that make the local path of the contour error.
constexpr int kLocalPathReach = 8;
/// In which the difference of two controllers' forces fades.
constexpr double kBlend_s = 0.03;
/// Damping ratio of an axis held by a spring, friction apart.
constexpr double kSpringDamping = 0.7;

/// Whether carrying these orders out touches what is followed.
bool ChangesPath(const Orders& o) noexcept {
  return o.hold_here || o.forget_path || o.expect_path || o.start_path || o.stop_path || !o.torque_allowed;
}

PerAxis<double> Zeros(std::size_t n) {
  PerAxis<double> zeros(n);
  for (double& z : zeros) z = 0.0;
  return zeros;
}

}  // namespace

Cycle::Axis::Axis(const CycleAxisConfig& config, const MonitoredAxis& monitored,
                  const MonitorConfig& monitoring, EstimatorKind kind, double period_s)
    : radius_m_rad(config.mechanics.radius_m_rad),
      estimator(kind, config.mechanics, config.friction, config.estimator, period_s, config.lag_s,
                2.0 * std::numbers::pi * config.mechanics.radius_m_rad / config.encoder_counts_per_rev,
                config.known),
      observer(EstimatorKind::kDisturbanceObserver, config.mechanics, config.friction, config.estimator,
               period_s, config.lag_s,
               2.0 * std::numbers::pi * config.mechanics.radius_m_rad / config.encoder_counts_per_rev),
      monitor(monitored, monitoring, period_s),
      mass_kg(config.mechanics.mass_kg),
      unreferenced_travel_m(1e-3 * config.limits.unreferenced_travel_mm),
      following_error_m(1e-3 * config.limits.following_error_mm),
      position_min_m(1e-3 * config.limits.position_mm[0]),
      position_max_m(1e-3 * config.limits.position_mm[1]) {}

Cycle::Cycle(const CycleConfig& config)
    : period_s_(config.cycle_us * 1e-6),
      master_(config.master),
      transitions_(TransitionTimes(config)),
      reasons_(config.cycle_us),
      follower_(config.axes.size(), period_s_, StopOnPathTime_s(config) / period_s_, kMaxHorizonPoints),
      controller_(MakeController(config)),
      fallback_(MakeFallback(config)),
      watch_(config),
      blend_kept_(std::exp(-period_s_ / kBlend_s)),
      guard_(config.control.guard, GuardedAxes(config), period_s_),
      csp_(InCascade(config)),
      by_reported_torque_(csp_ && config.controller == ControllerName::kFull),
      soft_loop_rel_(config.control.supervision.softer * config.control.supervision.softer),
      most_skipped_(static_cast<std::uint32_t>(config.control.guard.stale_cycles)),
      estimates_(config.axes.size()),
      guarded_(config.axes.size()),
      setpoints_(config.axes.size()),
      near_position_m_(config.axes.size()),
      near_path_(config.axes.size()) {
  const PerAxis<MonitoredAxis> monitored = MonitoredAxes(config);
  for (std::size_t i = 0; i < config.axes.size(); ++i)
    axes_.emplace_back(config.axes[i], monitored[i], config.control.monitor, EstimatorFor(config), period_s_);
  for (const AxisDriveConfig& a : config.master.axes)
    answers_.push_back({{static_cast<std::uint16_t>(cob::kTpdo1 + a.drive.node_id), 0, {}}, a.bus, 0});
  for (const BusConfig& b : config.master.buses) {
    const auto bus = static_cast<std::uint8_t>(heartbeats_.size());
    heartbeats_.push_back(
        {HeartbeatFrame(static_cast<std::uint8_t>(b.master_node_id), NmtState::kOperational), bus, 0});
  }
  bus_nodes_.resize(config.master.buses.size());
  for (const AxisDriveConfig& a : config.master.axes) bus_nodes_[a.bus].Add(a.drive.node_id);
  for (const Reason r : config.unsupervised) unsupervised_[static_cast<std::size_t>(r)] = true;
  const std::size_t n = axes_.size();
  control_in_.reference.resize(n);
  control_in_.friction.resize(n);
  control_in_.previous_force_N = Zeros(n);
  control_out_.force_N = Zeros(n);
  control_out_.feedforward_N = Zeros(n);
  control_out_.target_position_m = Zeros(n);
  control_out_.limit.resize(n);
  follower_.Hold(Zeros(n));
  StateKeeper measuring;
  controller_.Keep(measuring);
  handover_.resize(measuring.used());
}

bool Cycle::TakeController(ContourController& next) noexcept CONTOUR_NONBLOCKING {
  StateKeeper saving = StateKeeper::Saving(handover_);
  controller_.Keep(saving);
  StateKeeper loading = StateKeeper::Loading(handover_);
  next.Keep(loading);
  if (!saving.whole() || !loading.whole()) return false;
  // What is destroyed in between has been moved from, and owns nothing.
  CONTOUR_KNOWN_NONBLOCKING(std::swap(controller_, next);)
  return true;
}

void Cycle::Step(const CycleInput& in, CycleOutput& out, StageSink* stages) noexcept CONTOUR_NONBLOCKING {
  Act(in, out, stages);
  Report(in, out);
}

void Cycle::Act(const CycleInput& in, CycleOutput& out, StageSink* stages) noexcept CONTOUR_NONBLOCKING {
  Observe(in);
  Monitor();
  Estimate(in.io);
  WatchItself();
  if (stages != nullptr) stages->Passed(CycleStage::kEstimated);
  Orders orders = transitions_.Step(Assess(in));
  CarryOut(orders, in.request);
  Decide(orders);
  if (stages != nullptr) stages->Passed(CycleStage::kDecided);
  // What the monitor sees says more of the cause than a limit that is exceeded by it.
  const FaultSeen exceeded = Guard(orders);
  const FaultSeen fault = contradiction_.reason != Reason::kNone ? contradiction_ : exceeded;
  // Without torque a fault of the guard moves nothing, and the enabling to come starts everything anew.
  const bool enabling = contradiction_.reason != Reason::kNone && orders.goal == DriveGoal::kEnabled;
  if (fault.reason != Reason::kNone && (orders.torque_allowed || enabling)) {
    orders = transitions_.RaiseLate(fault);
    CarryOut(orders, in.request);
    Guard(orders);
  }
  // Seen together with another fault: that axis must not be braked by its encoder either.
  if (transitions_.state() == MachineState::kFaulted && RampInDoubt(contradiction_.reason))
    orders.voltage_off = contradiction_.where;
  reasons_.Update(transitions_, master_);
  guard_.Skip(skipped_);
  Command(orders, out);
  out.finished = orders.finished;
}

bool Cycle::FeedbackComplete(const CycleInput& in) const noexcept {
  for (const StampedFrame& answer : answers_) {
    bool found = false;
    for (const StampedFrame& f : in.frames)
      found = found || (f.bus == answer.bus && f.frame.id == answer.frame.id);
    if (!found) return false;
  }
  return true;
}

void Cycle::EncodeHeartbeat(CycleOutput& out) const noexcept {
  for (const StampedFrame& f : heartbeats_)
    if (master_.HeartbeatRuns(f.bus)) out.frames.push_back(f);
}

void Cycle::Keep(StateKeeper& keep) noexcept {
  keep(master_, axes_, transitions_, reasons_, follower_, controller_, fallback_, watch_, acted_, take_over_,
       late_, guard_, estimates_, control_in_, control_out_, guarded_, setpoints_, near_position_m_,
       near_path_, stale_cycles_, skipped_before_);
}

std::size_t Cycle::StateSize() noexcept {
  StateKeeper measuring;
  Keep(measuring);
  return measuring.used();
}

void Cycle::SaveState(std::span<std::byte> to) noexcept CONTOUR_NONBLOCKING {
  StateKeeper saving = StateKeeper::Saving(to);
  Keep(saving);
}

bool Cycle::LoadState(std::span<const std::byte> from) noexcept {
  StateKeeper loading = StateKeeper::Loading(from);
  Keep(loading);
  return loading.whole();
}

void Cycle::Observe(const CycleInput& in) noexcept {
  master_.Receive(in);
  for (const PathPoint& p : in.path) follower_.Accept(p);
  // Time has gone by at skipped grid points too, and with it the reference.
  skipped_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(master_.elapsed_cycles() - 1, most_skipped_));
  for (std::uint32_t i = 0; i <= skipped_; ++i) follower_.Advance();
  bool stale = false;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const AxisFeedback& f = master_.feedback()[i];
    axes_[i].position_m = f.position_rad * axes_[i].radius_m_rad;
    stale = stale || (f.valid && !f.fresh);
    follower_.Horizon(i, controller().horizon_points(), control_in_.reference[i]);
  }
  if (stale && master_.operational()) ++stale_cycles_;
}

/// Holds what the encoders say against the torque that acted, before anybody learns from it.
void Cycle::Monitor() noexcept {
  contradiction_ = {};
  // While others are still being enabled, a drive that is holds its axis already.
  const bool holds = transitions_.holds_torque() || transitions_.state() == MachineState::kEnabling;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    const AxisFeedback& f = master_.feedback()[i];
    const ReferencePoint sampled = AtSample(i);
    MotionSample s;
    s.enabled = holds && f.drive_state == DriveState::kOperationEnabled;
    s.fresh = f.fresh;
    s.late = late_;
    s.periods = skipped_before_ + 1;
    s.position_m = axis.position_m;
    s.sent_force_N = axis.sent_force_N[0];
    s.reported_force_N = f.torque_Nm / axis.radius_m_rad;
    s.reference_m = sampled.position_m;
    s.loop_rel = csp_ || watch_.step() < SupervisionStep::kSoftened ? 1.0 : soft_loop_rel_;
    s.spring_N_m = csp_ ? 0.0 : control_in_.reference[i][1].spring_N_m;
    s.has_scale = f.has_scale;
    s.table_position_m = f.table_position_m;
    const Reason reason = axis.monitor.Step(s);
    if (reason != Reason::kNone && contradiction_.reason == Reason::kNone)
      contradiction_ = {reason, static_cast<std::uint8_t>(i)};
  }
  skipped_before_ = skipped_;
}

void Cycle::Estimate(const IoInput& io) noexcept {
  const bool holds = transitions_.holds_torque();
  std::size_t moving = 0;
  for (std::size_t i = 0; i < axes_.size(); ++i) moving += AtSample(i).velocity_m_s != 0.0 ? 1u : 0u;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    const AxisFeedback& f = master_.feedback()[i];
    const ReferencePoint commanded = AtSample(i);
    AxisEstimatorInput input;
    input.position_m = axis.position_m;
    input.fresh = f.fresh && axis.monitor.believed();
    input.force_N = axis.sent_force_N;
    if (by_reported_torque_) {
      // What the drive's own loops made of it, at the ends of the period that has passed.
      const double now_N = f.torque_Nm / axis.radius_m_rad;
      input.force_N = {now_N, 0.5 * (now_N + axis.reported_N), axis.reported_N};
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
}

// Nothing was sent at the skipped grid points, so the newest feedback is that much older, and the last torque
// has acted on since.
ReferencePoint Cycle::AtSample(std::size_t axis) const noexcept {
  if (skipped_ == 0) return control_in_.reference[axis][0];
  return follower_.Near(axis, -static_cast<int>(skipped_));
}

// From the newest feedback to one period before the torque now being computed, under the torque that acted.
void Cycle::CatchUp(Axis& axis, std::size_t index, AxisEstimatorInput input) noexcept {
  const AxisEstimate measured = estimates_[index];
  AxisEstimator& estimator = fallen_back() ? axis.observer : axis.estimator;
  const double held_N = input.force_N[0];
  input.fresh = false;
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
  now.diverged = now.diverged || measured.diverged;
}

Situation Cycle::Assess(const CycleInput& in) const noexcept {
  Situation now;
  now.request = in.request;
  now.io = in.io;
  now.operational = master_.operational();
  now.bring_up_failed = master_.bring_up_failed();
  now.bring_up_active = master_.BringingUp();
  for (const AxisFeedback& f : master_.feedback()) now.drives.push_back(f.drive_state);
  now.fault = FindFault();
  now.lost = FindLost(in);
  now.stop = FindStop();
  now.stuck = FindStuck();
  if (const std::uint8_t bus = master_.second_master(); bus != DriveMaster::kNoBus)
    now.second_master = {Reason::kSecondMaster, bus};
  now.not_referenced = NotReferenced();
  now.can_reference = CanReference(in.request);
  now.path_prefetched = follower_.Prefetched();
  now.path_begins_here = now.path_prefetched && PathBeginsHere();
  now.path_running_dry = follower_.running_dry();
  now.path_at_end = follower_.at_end();
  now.path_at_rest = follower_.at_rest();
  return now;
}

FaultSeen Cycle::FindFault() const noexcept {
  const MachineState state = transitions_.state();
  if (skipped_ >= most_skipped_ && follower_.moving()) return {Reason::kGridPointsSkipped, 0xFF};
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const auto where = static_cast<std::uint8_t>(i);
    const AxisDriveStatus& status = master_.status()[i];
    // Why it stopped says more than that it did.
    if (status.lost_master && Acts(Reason::kDriveLostMaster)) return {Reason::kDriveLostMaster, where};
    if (status.fault && Acts(Reason::kDriveFault)) return {Reason::kDriveFault, where};
    if (status.emergency >= EmergencyReaction::kQuickStop && Acts(Reason::kDriveEmergency))
      return {Reason::kDriveEmergency, where, status.emergency == EmergencyReaction::kVoltageOff};
    if (state != MachineState::kEnabling && status.left_enabled && Acts(Reason::kDriveLeftEnabled))
      return {Reason::kDriveLeftEnabled, where};
    if (status.mode_changed && Acts(Reason::kModeChanged)) return {Reason::kModeChanged, where};
    if (status.not_following && Acts(Reason::kDriveNotFollowing)) return {Reason::kDriveNotFollowing, where};
    if (estimates_[i].diverged) return {Reason::kEstimatorDiverged, where};
  }
  return watch_.Fault();
}

FaultSeen Cycle::FindLost(const CycleInput& in) const noexcept {
  for (std::size_t b = 0; b < in.buses.size(); ++b) {
    const auto where = static_cast<std::uint8_t>(b);
    if (in.buses[b].bus_off) return {Reason::kBusOff, where};
    if (!in.buses[b].up && Acts(Reason::kBusDown)) return {Reason::kBusDown, where};
    if (in.buses[b].send_failures != 0 && Acts(Reason::kSendFailed)) return {Reason::kSendFailed, where};
  }
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const auto where = static_cast<std::uint8_t>(i);
    const AxisDriveStatus& s = master_.status()[i];
    const bool left_operational = s.configured && s.nmt != NmtState::kOperational;
    if (s.restarted && Acts(Reason::kDriveRestarted)) return {Reason::kDriveRestarted, where};
    if (s.lost_master && left_operational && Acts(Reason::kDriveLostMaster))
      return {Reason::kDriveLostMaster, where};
    if (s.heartbeat_lost && Acts(Reason::kHeartbeatLost)) return {Reason::kHeartbeatLost, where};
    if (left_operational && Acts(Reason::kDriveLeftOperational))
      return {Reason::kDriveLeftOperational, where};
  }
  return {};
}

FaultSeen Cycle::FindStop() const noexcept {
  for (std::size_t i = 0; i < axes_.size(); ++i)
    if (master_.status()[i].emergency == EmergencyReaction::kStopOnPath && Acts(Reason::kDriveEmergency))
      return {Reason::kDriveEmergency, static_cast<std::uint8_t>(i)};
  return watch_.Stop();
}

std::uint8_t Cycle::FindStuck() const noexcept {
  for (std::size_t i = 0; i < axes_.size(); ++i)
    if (master_.status()[i].transition_late) return static_cast<std::uint8_t>(i);
  return 0xFF;
}

bool Cycle::PathBeginsHere() const noexcept {
  const PathPoint& first = follower_.First();
  if (first.axes.size() != axes_.size()) return false;
  for (std::size_t i = 0; i < axes_.size(); ++i)
    if (!(std::abs(first.axes[i].position_m - control_in_.reference[i][0].position_m) <=
          kPathStartTolerance_m))
      return false;
  return true;
}

// Of an axis that knew where it is, or moved, and does not any more, no program can be right. One that was
// never told may move as far as the operator says.
std::uint8_t Cycle::NotReferenced() const noexcept {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const ReferenceState state = master_.reference(i);
    const bool may_move =
        IsReferenced(state) || (state == ReferenceState::kNeverTold && axes_[i].unreferenced_travel_m > 0.0);
    if (!may_move) return static_cast<std::uint8_t>(i);
  }
  return 0xFF;
}

bool Cycle::CanReference(const Request& request) const noexcept {
  if (request.kind != RequestKind::kReference) return false;
  const ReferenceRequest told = DecodeReference(request.program_id);
  return master_.CanTellPosition(told.axis) && told.position_m >= axes_[told.axis].position_min_m &&
         told.position_m <= axes_[told.axis].position_max_m;
}

void Cycle::TellWhere(const Request& request) noexcept {
  const ReferenceRequest told = DecodeReference(request.program_id);
  Axis& axis = axes_[told.axis];
  master_.TellPosition(told.axis, told.position_m / axis.radius_m_rad);
  axis.position_m = told.position_m;
}

// An incremental encoder that was not believed, or seemed faster than its axis can be, may have lost counts.
void Cycle::DoubtPosition() noexcept {
  if (transitions_.state() != MachineState::kFaulted) return;
  const std::uint8_t axis = transitions_.reason_where();
  if (axis >= axes_.size()) return;
  switch (transitions_.reason()) {
    case Reason::kFeedbackFrozen:
    case Reason::kFeedbackJump:
    case Reason::kFeedbackReversed:
    case Reason::kVelocityLimit:
      master_.DoubtPosition(axis);
      return;
    default:
      return;
  }
}

void Cycle::HoldHere() noexcept {
  PerAxis<double> here;
  for (Axis& axis : axes_) {
    here.push_back(axis.position_m);
    axis.estimator.Reset(axis.position_m);
    axis.sent_force_N = {};
  }
  follower_.Hold(here);
  controller_.Reset();
  guard_.Reset();
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (IsReferenced(master_.reference(i))) continue;
    const Axis& axis = axes_[i];
    // Where no program is allowed the axis only holds.
    const bool moves = master_.reference(i) == ReferenceState::kNeverTold && axis.unreferenced_travel_m > 0.0;
    guard_.Confine(i, moves ? axis.unreferenced_travel_m : axis.following_error_m);
  }
}

void Cycle::FollowFeedback() noexcept {
  PerAxis<double> here;
  for (const Axis& axis : axes_) here.push_back(axis.position_m);
  follower_.Hold(here);
}

void Cycle::CarryOut(const Orders& orders, const Request& request) noexcept {
  DoubtPosition();
  if (orders.reference) TellWhere(request);
  if (orders.start_bring_up) master_.StartBringUp();
  if (orders.fall_silent) master_.FallSilent();
  if (orders.hold_here) HoldHere();
  if (orders.forget_path) {
    PerAxis<double> here;
    for (std::size_t i = 0; i < axes_.size(); ++i) here.push_back(control_in_.reference[i][0].position_m);
    follower_.Hold(here);
  }
  // Where nothing is held, the reference is where the axes are: nothing jumps when they are enabled.
  if (!orders.torque_allowed) FollowFeedback();
  if (orders.expect_path) follower_.Expect(transitions_.program_id());
  if (orders.start_path) follower_.Start();
  if (orders.stop_path) follower_.BeginStop();
}

void Cycle::Decide(const Orders& orders) noexcept {
  // The path ahead is what Observe found, unless an order has just changed it.
  if (ChangesPath(orders))
    for (std::size_t i = 0; i < axes_.size(); ++i)
      follower_.Horizon(i, controller().horizon_points(), control_in_.reference[i]);
  ContourController& in_use = controller();
  in_use.Plan(control_in_, orders.torque_allowed);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    AxisEstimator& estimator = fallen_back() ? axes_[i].observer : axes_[i].estimator;
    estimator.PreviewFriction(Reference(control_in_)[i], in_use.friction_points(), control_in_.friction[i]);
    control_in_.previous_force_N[i] = axes_[i].sent_force_N[0];
  }
  control_in_.estimate = estimates_;
  if (orders.torque_allowed) {
    in_use.Step(control_in_, control_out_);
    Blend();
    HoldBySprings();
  } else {
    // Whatever it found would not be sent, and axes that are moved by hand would keep its solver busy.
    in_use.Rest(control_out_);
    for (Axis& axis : axes_) axis.blend_N = 0.0;
  }
}

// The ladder's step of this cycle, and what controllers and estimators have to do with it.
void Cycle::WatchItself() noexcept {
  const bool had_fallen_back = fallen_back();
  if (transitions_.holds_torque()) {
    for (std::size_t i = 0; i < axes_.size(); ++i)
      watch_.Look(i, {master_.feedback()[i], estimates_[i], AtSample(i), axes_[i].position_m,
                      axes_[i].radius_m_rad, control_out_.limit[i] == Reason::kSolverCap});
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
  take_over_ = transitions_.holds_torque() && std::max(acted_, watch_.step()) >= SupervisionStep::kSoftened;
  acted_ = watch_.step();
}

// A change of controller takes over the force that is there; the difference fades.
void Cycle::Blend() noexcept {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    double& blend_N = axes_[i].blend_N;
    if (take_over_) blend_N = axes_[i].sent_force_N[0] - control_out_.force_N[i];
    control_out_.force_N[i] += blend_N;
    blend_N *= blend_kept_;
  }
  take_over_ = false;
}

/// Where an experiment asks for it, a damped spring towards the reference takes the controller's place: weak
/// enough to let friction be felt, and no compensation answers the torque that is put on. In CSP the drive
/// itself holds the axis, and goes on doing so.
void Cycle::HoldBySprings() noexcept {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const ReferencePoint& ahead = control_in_.reference[i][1];
    if (csp_ || !(ahead.spring_N_m > 0.0)) continue;
    const double damping_Ns_m = 2.0 * kSpringDamping * std::sqrt(ahead.spring_N_m * axes_[i].mass_kg);
    control_out_.force_N[i] = ahead.spring_N_m * (ahead.position_m - estimates_[i].predicted_position_m) +
                              damping_Ns_m * (ahead.velocity_m_s - estimates_[i].predicted_velocity_m_s);
    control_out_.feedforward_N[i] = 0.0;
    control_out_.limit[i] = Reason::kNone;
    controller_.Release(i);
  }
}

FaultSeen Cycle::Guard(const Orders& orders) noexcept {
  FaultSeen fault;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    // In CSP this is the torque offset; the drive's cascade makes the rest, and the guard watches the axis.
    const double controller_Nm = control_out_.force_N[i] * axes_[i].radius_m_rad;
    axes_[i].wanted_torque_Nm = controller_Nm + control_in_.reference[i][1].extra_torque_Nm;
    guarded_[i] = guard_.Limit(i, axes_[i].wanted_torque_Nm, master_.feedback()[i], AtSample(i).position_m,
                               orders.torque_allowed);
    if (guarded_[i].fault != Reason::kNone && fault.reason == Reason::kNone) {
      fault = {guarded_[i].fault, static_cast<std::uint8_t>(i)};
      // An axis that runs away against its torque must not be braked by the encoder that says so.
      const bool ran_away = fault.reason == Reason::kFollowingError || fault.reason == Reason::kVelocityLimit;
      if (const Reason doubt = axes_[i].monitor.Doubt(); ran_away && doubt != Reason::kNone)
        fault.reason = doubt;
    }
  }
  return fault;
}

void Cycle::Command(const Orders& orders, CycleOutput& out) noexcept {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    AxisSetpoint& s = setpoints_[i];
    s.goal = i == orders.voltage_off ? DriveGoal::kDisabled : orders.goal;
    s.torque_Nm = guarded_[i].torque_Nm;
    s.in_motion = control_in_.reference[i][0].velocity_m_s != 0.0;
    // Until the axis is held, the target follows the axis, so that a drive in CSP does not jump when enabled.
    s.position_rad = (orders.torque_allowed ? control_out_.target_position_m[i] : axes_[i].position_m) /
                     axes_[i].radius_m_rad;
  }
  out.frames.clear();
  master_.Send(setpoints_, out.frames);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    auto& sent = axes_[i].sent_force_N;
    sent = {master_.sent_torque_Nm()[i] / axes_[i].radius_m_rad, sent[0], sent[1]};
  }
}

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
  r.path_time_s = follower_.moving() || follower_.at_end() ? follower_.path_time() * period_s_ : 0.0;
  r.path_points_waiting = static_cast<std::uint16_t>(follower_.waiting());
  r.solver_iterations = static_cast<std::uint16_t>(control_out_.iterations);
  r.stale_cycles = stale_cycles_;
  r.io = in.io;
  r.bring_up = master_.bring_up();
  r.axes.resize(axes_.size());
  for (std::size_t i = 0; i < axes_.size(); ++i) RecordAxis(i, r.axes[i]);
  RecordContourError(r);
  const bool waits =
      (r.state == MachineState::kIdle || r.state == MachineState::kReady) && !transitions_.run_pending();
  const bool over = r.state == MachineState::kFaulted && transitions_.drives_off();
  const bool lost = r.state == MachineState::kFaulted && transitions_.since() >= kFaultSettledCycles;
  out.quiescent = ((waits || over) && transitions_.since() >= kSettledCycles) || lost;
  out.settling = (waits || r.state == MachineState::kFaulted) && !out.quiescent;
}

void Cycle::RecordContourError(CycleRecord& record) noexcept {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    near_position_m_[i] = axes_[i].position_m;
    follower_.Around(i, kLocalPathReach, near_path_[i]);
  }
  const ContourError error =
      FindContourError(near_position_m_, near_path_, period_s_, static_cast<std::size_t>(kLocalPathReach));
  record.contour_error_m = error.contour_m;
  record.lag_error_m = error.lag_m;
}

void Cycle::RecordAxis(std::size_t i, AxisRecord& r) const noexcept {
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
