#include "daemon/rt/cycle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "control/motion_thresholds.h"
#include "daemon/rt/cycle_parts.h"
#include "drivers/cia301/messages.h"

namespace contour {
namespace {

/// In which the difference of two controllers' forces fades.
constexpr double kBlend_s = 0.03;
/// More grid points than that are not told apart: readings so far apart say nothing of each other.
constexpr std::uint64_t kMostSkipped = 1'000'000;

/// Of the longest frame: more than stuff bits of the frames before a SYNC make of its time.
constexpr double kStuffing = 0.25;
double Loop_rad_s(const CycleConfig& config) {
  const double loop_Hz = StiffnessLoop_Hz(config);
  return std::isfinite(loop_Hz) ? 2.0 * std::numbers::pi * loop_Hz : 0.0;
}

/// Of an encoder, that neighbouring readings may be off by.
constexpr double kSteps = 4.0;

/// An axis that its loop, of bandwidth w, brakes within its limit of acceleration: from speed v by
/// kLoopOvershoot times w v at most. Or whose speed is that of counts that flicker.
double Standing_m_s(const CycleConfig& config, std::size_t axis, double flicker_m) {
  const double loop_rad_s = Loop_rad_s(config);
  if (!(loop_rad_s > 0.0)) return std::numeric_limits<double>::infinity();
  return std::max(1e-3 * config.axes[axis].limits.acceleration_mm_s2 / (kLoopOvershoot * loop_rad_s),
                  flicker_m / (1e-6 * config.cycle_us));
}

PerAxis<double> Zeros(std::size_t n) {
  PerAxis<double> zeros(n);
  for (double& z : zeros) z = 0.0;
  return zeros;
}

PerAxis<StopLimits> StopLimitsOf(const CycleConfig& config) {
  PerAxis<StopLimits> limits;
  for (const CycleAxisConfig& a : config.axes)
    limits.push_back({1e-3 * a.limits.acceleration_mm_s2, 1e-3 * a.limits.jerk_mm_s3});
  return limits;
}

}  // namespace

Cycle::Axis::Axis(const CycleConfig& cycle, std::size_t index, const MonitoredAxis& monitored)
    : radius_m_rad(cycle.axes[index].mechanics.radius_m_rad),
      estimator(MakeEstimator(cycle, index)),
      observer(MakeObserver(cycle, index)),
      known(cycle.axes[index].known),
      monitor(monitored, cycle.control.monitor, cycle.cycle_us * 1e-6, cycle.off),
      in_period(cycle.cycle_us * 1e-6, cycle.axes[index].lag_s),
      acts_after(std::min<std::size_t>(
          static_cast<std::size_t>(std::max(1, cycle.master.axes[index].drive.delay_cycles)) - 1,
          sent_force_N.size() - 1)),
      unreferenced_travel_m(1e-3 * cycle.axes[index].limits.unreferenced_travel_mm),
      following_error_m(1e-3 * cycle.axes[index].limits.following_error_mm),
      position_min_m(1e-3 * cycle.axes[index].limits.position_mm[0]),
      position_max_m(1e-3 * cycle.axes[index].limits.position_mm[1]),
      safe_travel_m(1e-3 * cycle.axes[index].limits.safe_travel_mm),
      speed_kept(std::exp(-1e-6 * cycle.cycle_us * Loop_rad_s(cycle))),
      standing_m_s(Standing_m_s(cycle, index, kSteps * monitored.count_m * (1.0 - speed_kept))),
      late_from_s(kStuffing * monitored.sample_jitter_s),
      late_from_m(kSteps * monitored.count_m) {}

Cycle::Cycle(const CycleConfig& config)
    : period_s_(config.cycle_us * 1e-6),
      axis_count_(config.axes.size()),
      master_(config.master),
      transitions_(TransitionTimes(config)),
      reasons_(config.cycle_us),
      follower_(StopLimitsOf(config), period_s_, StopOnPathTime_s(config) / period_s_, kMaxHorizonPoints),
      controller_(MakeController(config)),
      fallback_(MakeFallback(config)),
      watch_(config),
      blend_kept_(std::exp(-period_s_ / kBlend_s)),
      guard_(config.control.guard, GuardedAxes(config), period_s_, config.off),
      csp_(InCascade(config)),
      same_law_(KnowsTwoInertias(config) && !csp_),
      by_reported_torque_(csp_ && config.controller == ControllerName::kFull),
      two_inertias_(KnowsTwoInertias(config)),
      off_(config.off),
      most_skipped_(static_cast<std::uint32_t>(config.control.guard.stale_cycles)),
      estimates_(config.axes.size()),
      guarded_(config.axes.size()),
      setpoints_(config.axes.size()),
      near_position_m_(config.axes.size()),
      near_path_(config.axes.size()) {
  const PerAxis<MonitoredAxis> monitored = MonitoredAxes(config);
  for (std::size_t i = 0; i < config.axes.size(); ++i) axes_.emplace_back(config, i, monitored[i]);
  for (const AxisDriveConfig& a : config.master.axes)
    answers_.push_back({{static_cast<std::uint16_t>(cob::kTpdo1 + a.drive.node_id), 0, {}}, a.bus, 0});
  for (const BusConfig& b : config.master.buses) {
    const auto bus = static_cast<std::uint8_t>(heartbeats_.size());
    heartbeats_.push_back(
        {HeartbeatFrame(static_cast<std::uint8_t>(b.master_node_id), NmtState::kOperational), bus, 0});
  }
  bus_nodes_.resize(config.master.buses.size());
  for (const AxisDriveConfig& a : config.master.axes) bus_nodes_[a.bus].Add(a.drive.node_id);
  const std::size_t n = axis_count_;
  control_in_.estimate.resize(n);
  control_in_.reference.resize(n);
  control_in_.friction.resize(n);
  control_in_.stated.resize(n);
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
  TellLoop();
  return true;
}

void Cycle::Step(const CycleInput& in, CycleOutput& out, StageSink* stages) noexcept CONTOUR_NONBLOCKING {
  Act(in, out, stages);
  Report(in, out);
}

void Cycle::Act(const CycleInput& in, CycleOutput& out, StageSink* stages) noexcept CONTOUR_NONBLOCKING {
  const auto passed = [&](CycleStage stage) noexcept CONTOUR_NONBLOCKING {
    if (stages != nullptr) stages->Passed(stage);
  };
  const Feedback& feedback = Observe(in);
  const FaultSeen contradiction = Contradiction(feedback);
  const Estimates& estimate = Estimate(feedback, in.io);
  WatchItself(feedback, estimate);
  passed(CycleStage::kEstimated);
  Orders orders = transitions_.Step(Assess(in, estimate));
  CarryOut(orders, in.request);
  const ControlOutput& wanted = Decide(orders, estimate);
  passed(CycleStage::kDecided);
  const PerAxis<GuardedTorque>& limited = Limit(wanted, feedback, contradiction, in.request, orders);
  reasons_.Update(transitions_, master_);
  Send(orders, wanted, limited, out.frames);
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
  TellLoop();
  return loading.whole();
}

const Cycle::Feedback& Cycle::Observe(const CycleInput& in) noexcept {
  master_.Receive(in);
  for (const PathPoint& p : in.path) follower_.Accept(p);
  // Time has gone by at skipped grid points too, and with it the reference.
  skipped_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(master_.elapsed_cycles() - 1, most_skipped_));
  for (std::uint32_t i = 0; i <= skipped_; ++i) follower_.Advance();
  bool stale = false;
  const bool holds = transitions_.holds_torque();
  const std::size_t ahead = controller().horizon_points();
  for (std::size_t i = 0; i < axis_count_; ++i) {
    const AxisFeedback& f = master_.feedback()[i];
    axes_[i].position_m = f.position_rad * axes_[i].radius_m_rad;
    // Only who asks for `enable` wants to know.
    if (holds)
      axes_[i].seen = false;
    else
      MeasureSpeed(axes_[i], f);
    if (f.sync_late_s != 0.0 || f.late_s > axes_[i].late_from_s) TakeLateness(i, f);
    stale = stale || (f.valid && !f.fresh);
    follower_.Horizon(i, ahead, control_in_.reference[i]);
  }
  if (stale && master_.operational()) ++stale_cycles_;
  return master_.feedback();
}

// A reading after a gap says nothing of the speed now.
void Cycle::MeasureSpeed(Axis& axis, const AxisFeedback& feedback) noexcept {
  axis.unseen_cycles += master_.elapsed_cycles();
  if (!feedback.fresh) {
    if (axis.unseen_cycles > most_skipped_) axis.speed_m_s = 0.0;
    return;
  }
  if (!axis.seen) {
    axis.speed_m_s = 0.0;
  } else if (axis.unseen_cycles <= most_skipped_) {
    const double now_m_s =
        (axis.position_m - axis.seen_at_m) / (period_s_ * static_cast<double>(axis.unseen_cycles));
    axis.speed_m_s = axis.speed_kept * axis.speed_m_s + (1.0 - axis.speed_kept) * now_m_s;
  }
  axis.seen = true;
  axis.seen_at_m = axis.position_m;
  axis.unseen_cycles = 0;
}

/// Holds what the encoders say against the torque that acted, before anybody learns from it.
FaultSeen Cycle::Contradiction(const Feedback& feedback) noexcept {
  FaultSeen first;
  // While others are still being enabled, a drive that is holds its axis already.
  const bool holds = transitions_.holds_torque() || transitions_.state() == MachineState::kEnabling;
  for (std::size_t i = 0; i < axis_count_; ++i) {
    Axis& axis = axes_[i];
    const AxisFeedback& f = feedback[i];
    MotionSample s;
    s.enabled = holds && f.drive_state == DriveState::kOperationEnabled;
    s.fresh = f.fresh;
    s.late = late_;
    s.periods = skipped_before_ + 1;
    s.position_m = axis.position_m;
    s.sent_force_N = axis.sent_force_N[0];
    s.reported_force_N = f.torque_Nm / axis.radius_m_rad;
    s.reference_m = AtSample(i).position_m;
    // The newest target is that of the sample to come.
    s.lead_m =
        csp_ ? setpoints_[i].position_rad * axis.radius_m_rad - control_in_.reference[i][1].position_m : 0.0;
    s.spring_N_m = csp_ ? 0.0 : control_in_.reference[i][1].spring_N_m;
    s.has_scale = f.has_scale && (f.scale_fresh || !two_inertias_);
    s.table_position_m = f.has_scale ? TableAt_m(i, f) : 0.0;
    const Reason reason = axis.monitor.Step(s);
    // Of a swing that not even the screw explains, no ramp is to be relied upon either.
    const bool no_ramp = RampInDoubt(reason) || reason == Reason::kOscillation;
    if (reason != Reason::kNone && first.reason == Reason::kNone)
      first = {reason, static_cast<std::uint8_t>(i), no_ramp};
  }
  skipped_before_ =
      static_cast<std::uint32_t>(std::min<std::uint64_t>(master_.elapsed_cycles() - 1, kMostSkipped));
  return first;
}

/// The torque limits. What contradicts itself, or goes beyond what it may, still changes this cycle's orders.
const PerAxis<GuardedTorque>& Cycle::Limit(const ControlOutput& wanted, const Feedback& feedback,
                                           const FaultSeen& contradiction, const Request& request,
                                           Orders& orders) noexcept {
  // What the monitor sees says more of the cause than a limit that is exceeded by it.
  const FaultSeen exceeded = Guard(wanted, feedback, orders.torque_allowed);
  const FaultSeen fault = contradiction.reason != Reason::kNone ? contradiction : exceeded;
  // Without torque a fault of the guard moves nothing, and the enabling to come starts everything anew.
  const bool enabling = contradiction.reason != Reason::kNone && orders.goal == DriveGoal::kEnabled;
  if (fault.reason != Reason::kNone && (orders.torque_allowed || enabling)) {
    orders = transitions_.RaiseLate(fault);
    CarryOut(orders, request);
    Guard(wanted, feedback, orders.torque_allowed);
  }
  // Seen together with another fault: that axis must not be braked by its encoder either.
  if (transitions_.state() == MachineState::kFaulted && contradiction.voltage_off)
    orders.voltage_off = contradiction.where;
  guard_.Skip(skipped_);
  return guarded_;
}

FaultSeen Cycle::Guard(const ControlOutput& wanted, const Feedback& feedback, bool torque_allowed) noexcept {
  FaultSeen fault;
  for (std::size_t i = 0; i < axis_count_; ++i) {
    // In CSP this is the torque offset; the drive's cascade makes the rest, and the guard watches the axis.
    const double controller_Nm = wanted.force_N[i] * axes_[i].radius_m_rad;
    axes_[i].wanted_torque_Nm = controller_Nm + control_in_.reference[i][1].extra_torque_Nm;
    guarded_[i] = guard_.Limit(i, axes_[i].wanted_torque_Nm, feedback[i], AtSample(i).position_m,
                               torque_allowed, master_.SyncApart_s(i));
    if (guarded_[i].fault != Reason::kNone && fault.reason == Reason::kNone) {
      fault = {guarded_[i].fault, static_cast<std::uint8_t>(i)};
      // An axis that runs away against its torque must not be braked by the encoder that says so.
      const bool ran_away = fault.reason == Reason::kFollowingError || fault.reason == Reason::kVelocityLimit;
      if (const Reason doubt = axes_[i].monitor.Doubt(); ran_away && doubt != Reason::kNone)
        fault = {doubt, fault.where, true};
    }
  }
  return fault;
}

void Cycle::Send(const Orders& orders, const ControlOutput& wanted, const PerAxis<GuardedTorque>& limited,
                 FixedVector<StampedFrame, kMaxFramesSentPerCycle>& frames) noexcept {
  for (std::size_t i = 0; i < axis_count_; ++i) {
    AxisSetpoint& s = setpoints_[i];
    s.goal = i == orders.voltage_off ? DriveGoal::kDisabled : orders.goal;
    s.torque_Nm = limited[i].torque_Nm;
    s.in_motion = control_in_.reference[i][0].velocity_m_s != 0.0;
    // Until the axis is held, the target follows the axis, so that a drive in CSP does not jump when enabled.
    s.position_rad =
        (orders.torque_allowed ? wanted.target_position_m[i] : axes_[i].position_m) / axes_[i].radius_m_rad;
  }
  frames.clear();
  master_.Send(setpoints_, frames);
  for (std::size_t i = 0; i < axis_count_; ++i) {
    auto& sent = axes_[i].sent_force_N;
    sent = {master_.sent_torque_Nm()[i] / axes_[i].radius_m_rad, sent[0], sent[1]};
  }
}

}  // namespace contour
