#include "daemon/rt/transitions.h"

#include "control/motion_monitor.h"

namespace contour {
namespace {

bool Enabled(DriveState s) noexcept {
  return s == DriveState::kOperationEnabled || s == DriveState::kQuickStopActive ||
         s == DriveState::kFaultReactionActive;
}

bool AllOff(const Situation& now) noexcept {
  for (const DriveState s : now.drives)
    if (Enabled(s)) return false;
  return true;
}

bool AllEnabled(const Situation& now) noexcept {
  for (const DriveState s : now.drives)
    if (s != DriveState::kOperationEnabled) return false;
  return true;
}

constexpr std::uint8_t kNone = 0xFF;
/// Drives that gave no torque when the other master was seen are told "disable voltage" so often.
constexpr std::uint32_t kCyclesToSilence = 10;

/// Index of a drive that has not shown its state, or kNone.
std::uint8_t UnknownDrive(const Situation& now) noexcept {
  for (std::size_t i = 0; i < now.drives.size(); ++i)
    if (now.drives[i] == DriveState::kUnknown) return static_cast<std::uint8_t>(i);
  return kNone;
}

/// Index of a drive in Fault, or kNone.
std::uint8_t FaultedDrive(const Situation& now) noexcept {
  for (std::size_t i = 0; i < now.drives.size(); ++i)
    if (now.drives[i] == DriveState::kFault || now.drives[i] == DriveState::kFaultReactionActive)
      return static_cast<std::uint8_t>(i);
  return kNone;
}

/// Index of a drive in Operation Enabled, or kNone.
std::uint8_t EnabledDrive(const Situation& now) noexcept {
  for (std::size_t i = 0; i < now.drives.size(); ++i)
    if (now.drives[i] == DriveState::kOperationEnabled) return static_cast<std::uint8_t>(i);
  return kNone;
}

/// The drive that holds up enabling: one that missed its deadline, or else the first that is not there yet.
std::uint8_t StuckDrive(const Situation& now) noexcept {
  if (now.stuck < now.drives.size()) return now.stuck;
  for (std::size_t i = 0; i < now.drives.size(); ++i)
    if (now.drives[i] != DriveState::kOperationEnabled) return static_cast<std::uint8_t>(i);
  return kNone;
}

bool HoldsTorque(MachineState s) noexcept {
  return s == MachineState::kReady || s == MachineState::kRunning || s == MachineState::kStopping;
}

}  // namespace

void Transitions::Enter(MachineState next) noexcept {
  if (next == state_) return;
  state_ = next;
  stayed_ = since_;
  since_ = 0;
  operational_ = 0;
  run_pending_ = false;
  reset_pending_ = false;
}

void Transitions::Fault(FaultSeen fault) noexcept {
  reason_ = fault.reason;
  where_ = fault.where;
  // Where no ramp of that axis will do; the others have theirs.
  voltage_off_ = fault.voltage_off || RampInDoubt(fault.reason);
  Enter(MachineState::kFaulted);
}

void Transitions::Acknowledge(const Request& request, bool ok) noexcept {
  acknowledged_ = request.sequence;
  acknowledged_ok_ = ok;
}

Orders Transitions::Step(const Situation& now) noexcept {
  Orders orders;
  ++since_;
  drives_off_ = AllOff(now);
  Explain(now);
  if (state_ == MachineState::kIdle && reason_ == Reason::kAxisMoves && now.moves == kNone) {
    reason_ = Reason::kNone;
    where_ = kNone;
  }
  if (state_ == MachineState::kOff && !terminating_ && now.request.kind != RequestKind::kTerminate) {
    // The first bring-up begins by itself: finding and configuring drives moves nothing.
    orders.start_bring_up = true;
    Enter(MachineState::kStarting);
  }
  const bool may_move = state_ == MachineState::kEnabling || HoldsTorque(state_);
  if ((may_move || state_ == MachineState::kIdle) && now.second_master.reason != Reason::kNone) {
    // First: what else is seen may be the other master's doing.
    Fault(now.second_master);
  } else if (may_move && now.fault.reason != Reason::kNone) {
    Fault(now.fault);
  } else if ((may_move || state_ == MachineState::kIdle) && now.lost.reason != Reason::kNone) {
    Fault(now.lost);
  } else if (may_move) {
    WatchIo(now, orders);
    if (now.stop.reason != Reason::kNone) StopFor(now.stop, orders);
  }
  if (now.request.kind != RequestKind::kNone) HandleRequest(now, orders);
  Progress(now, orders);
  orders.torque_allowed = HoldsTorque(state_);
  SetGoals(orders);
  orders.fall_silent = SilentNow(now);
  return orders;
}

// What is seen of a drive that gets no set-points any more depends on speed and chance; it says itself why,
// only later: it waits for its watchdog, and for the inhibit time of its emergency messages.
void Transitions::Explain(const Situation& now) noexcept {
  if (state_ != MachineState::kFaulted || !now.says_lost_master || since_ > config_.explain_cycles) return;
  switch (reason_) {
    case Reason::kFollowingError:
    case Reason::kDriveFault:
    case Reason::kDriveLeftEnabled:
    case Reason::kDriveLeftOperational:
      reason_ = Reason::kDriveLostMaster;
      return;
    default:
      return;
  }
}

// Two masters must not go on commanding one machine. The drives are brought to rest by their own ramp first,
// which no other controlword ends but "disable voltage"; then the bus is left alone: what we sent would only
// quarrel with the other's frames, and two SYNCs a period are more than the bus can carry.
bool Transitions::SilentNow(const Situation& now) const noexcept {
  if (state_ != MachineState::kFaulted) return false;
  if (reason_ != Reason::kSecondMaster && now.second_master.reason == Reason::kNone) return false;
  return (drives_off_ && since_ >= kCyclesToSilence) || since_ > config_.stop_timeout_cycles;
}

Orders Transitions::RaiseLate(FaultSeen fault) noexcept {
  Fault(fault);
  Orders orders;
  orders.forget_path = true;
  SetGoals(orders);
  if (voltage_off_) orders.voltage_off = where_;
  return orders;
}

void Transitions::SetGoals(Orders& orders) const noexcept {
  orders.goal = Goal();
  if (voltage_off_ && state_ == MachineState::kFaulted) orders.voltage_off = where_;
}

void Transitions::WatchIo(const Situation& now, Orders& orders) noexcept {
  const Reason verdict = IoVerdict(now.io);
  if (verdict == Reason::kNone) return;
  // The emergency stop asks for the quickest stop there is, and so does anything before the axes are held.
  if (verdict == Reason::kEmergencyStop || state_ == MachineState::kEnabling) {
    Fault({verdict, 0xFF});
  } else {
    StopFor({verdict, 0xFF}, orders);
  }
}

void Transitions::StopFor(FaultSeen why, Orders& orders) noexcept {
  if (state_ == MachineState::kEnabling) {
    Fault(why);
  } else if (HoldsTorque(state_) &&
             (state_ != MachineState::kStopping || after_stop_ != MachineState::kFaulted)) {
    BeginStop(orders, why, MachineState::kFaulted);
  }
}

void Transitions::BeginStop(Orders& orders, FaultSeen why, MachineState after) noexcept {
  reason_ = why.reason;
  where_ = why.where;
  voltage_off_ = after == MachineState::kFaulted && RampInDoubt(why.reason);
  after_stop_ = after;
  orders.stop_path = true;
  // Who asks for a stop has time for it; a fault and a chain that opened have none.
  orders.within_limits = why.reason == Reason::kOperatorStop || why.reason == Reason::kDisableRequest ||
                         why.reason == Reason::kTerminate;
  Enter(MachineState::kStopping);
}

void Transitions::HandleRequest(const Situation& now, Orders& orders) noexcept {
  const Request& request = now.request;
  switch (request.kind) {
    case RequestKind::kNone:
      return;
    case RequestKind::kEnable:
      return Enable(now, orders, request);
    case RequestKind::kRun:
      return Run(now, orders, request);
    case RequestKind::kReset:
      if (state_ == MachineState::kFaulted) {
        reset_pending_ = true;
        reset_ = request;
      } else if (state_ == MachineState::kIdle) {
        // A drive may have fallen into Fault, or told of an error, while nothing was asked of it.
        reset_ = request;
        BeginReset(orders);
      } else {
        Acknowledge(request, false);
      }
      return;
    case RequestKind::kReference:
      return Reference(now, orders);
    case RequestKind::kTune:
      return Acknowledge(request, request.program_id != kNothingChanged);
    case RequestKind::kStop:
      Acknowledge(request, true);
      if (state_ == MachineState::kRunning) {
        BeginStop(orders, {Reason::kOperatorStop}, MachineState::kReady);
      } else if (state_ == MachineState::kReady && run_pending_) {
        run_pending_ = false;
        reason_ = Reason::kOperatorStop;
        orders.forget_path = true;
      } else if (state_ == MachineState::kEnabling) {
        reason_ = Reason::kOperatorStop;
        Enter(MachineState::kIdle);
      } else if (state_ == MachineState::kStopping) {
        orders.shorten_stop = true;  // who asks again is in a hurry
      }
      return;
    case RequestKind::kDisable:
    case RequestKind::kTerminate: {
      const bool terminate = request.kind == RequestKind::kTerminate;
      const Reason why = terminate ? Reason::kTerminate : Reason::kDisableRequest;
      terminating_ = terminating_ || terminate;
      Acknowledge(request, true);
      if (state_ == MachineState::kRunning || state_ == MachineState::kReady) {
        BeginStop(orders, {why}, MachineState::kIdle);
      } else if (state_ == MachineState::kStopping && after_stop_ == MachineState::kReady) {
        after_stop_ = MachineState::kIdle;
        reason_ = why;
      } else if (state_ == MachineState::kEnabling) {
        reason_ = why;
        Enter(MachineState::kIdle);
      }
      return;
    }
  }
}

void Transitions::Enable(const Situation& now, Orders& orders, const Request& request) noexcept {
  const bool may =
      state_ == MachineState::kIdle && now.operational && IoVerdict(now.io) == Reason::kNone && !terminating_;
  const bool ok = may && now.moves == kNone;
  Acknowledge(request, ok || state_ == MachineState::kReady);
  if (may && !ok) {
    // The loop would brake it as hard as it can.
    reason_ = Reason::kAxisMoves;
    where_ = now.moves;
  }
  if (!ok) return;
  reason_ = Reason::kNone;
  where_ = 0xFF;
  orders.hold_here = true;
  Enter(MachineState::kEnabling);
}

// A reset takes the voltage from the drives; it begins, and is acknowledged, when their quick-stop
// ramps have come to an end.
void Transitions::BeginReset(Orders& orders) noexcept {
  if (!drives_off_ && since_ <= config_.stop_timeout_cycles) return;
  Acknowledge(reset_, true);
  resetting_ = true;
  orders.start_bring_up = true;
  Enter(MachineState::kStarting);
}

// Nothing holds the axes then, so nothing moves when their positions become others.
void Transitions::Reference(const Situation& now, Orders& orders) noexcept {
  const bool ok = state_ == MachineState::kIdle && !terminating_ && now.can_reference;
  Acknowledge(now.request, ok);
  if (!ok) return;
  orders.reference = true;
  orders.hold_here = true;
  if (reason_ == Reason::kNotReferenced) {
    reason_ = Reason::kNone;
    where_ = kNone;
  }
}

void Transitions::Run(const Situation& now, Orders& orders, const Request& request) noexcept {
  const bool ready = state_ == MachineState::kReady && !run_pending_ && !terminating_;
  const bool ok = ready && now.not_referenced == kNone;
  Acknowledge(request, ok);
  if (ready && !ok) {
    reason_ = Reason::kNotReferenced;
    where_ = now.not_referenced;
  }
  if (!ok) return;
  program_id_ = request.program_id;
  reason_ = Reason::kNone;
  run_pending_ = true;
  run_pending_cycles_ = 0;
  orders.expect_path = true;
}

void Transitions::Progress(const Situation& now, Orders& orders) noexcept {
  switch (state_) {
    case MachineState::kOff:
      break;
    case MachineState::kStarting:
      ProgressStarting(now, orders);
      break;
    case MachineState::kIdle:
      break;
    case MachineState::kFaulted:
      if (reset_pending_) BeginReset(orders);
      break;
    case MachineState::kEnabling:
      if (orders.hold_here) break;
      // Until the drives hold, what they measure is what they shall hold.
      orders.hold_here = true;
      if (AllEnabled(now)) {
        Enter(MachineState::kReady);
      } else if (now.stuck != kNone || since_ > config_.enable_timeout_cycles) {
        Fault({Reason::kEnableTimeout, StuckDrive(now)});
      }
      break;
    case MachineState::kReady:
      ProgressReady(now, orders);
      break;
    case MachineState::kRunning:
      ProgressRunning(now, orders);
      break;
    case MachineState::kStopping:
      ProgressStopping(now, orders);
      break;
  }
  if (terminating_ && !HoldsTorque(state_) && state_ != MachineState::kEnabling)
    orders.finished = drives_off_ || since_ > config_.stop_timeout_cycles;
}

// A reset clears the drives' faults too; at the first start that is left to the operator. The time for that,
// and for the first statuswords, begins with the SYNCs that the drives answer: finding them may take long.
void Transitions::ProgressStarting(const Situation& now, Orders& orders) noexcept {
  if (orders.start_bring_up) return;
  if (now.bring_up_failed) {
    return Fault(now.second_master.reason != Reason::kNone ? now.second_master
                                                           : FaultSeen{Reason::kBringUpFailed, kNone});
  }
  if (now.bring_up_active) return;
  // Stopped by NMT from this cycle on; what follows from that is not the cause.
  if (now.lost.reason == Reason::kAnswersLate || now.lost.reason == Reason::kDriveStaysEnabled)
    return Fault(now.lost);
  // Lost again before all was well: nothing is under way any more, so nothing is waited for.
  if (!now.operational)
    return Fault(now.lost.reason != Reason::kNone ? now.lost : FaultSeen{Reason::kHeartbeatLost, kNone});
  const bool waits = ++operational_ <= config_.stop_timeout_cycles;
  if (const std::uint8_t unknown = UnknownDrive(now); unknown != kNone) {
    if (!waits) Fault({Reason::kStaleFeedback, unknown});
  } else if (const std::uint8_t faulted = FaultedDrive(now); faulted != kNone) {
    if (!resetting_ || !waits) Fault({Reason::kDriveFault, faulted});
  } else if (const std::uint8_t enabled = EnabledDrive(now); enabled != kNone) {
    if (!waits) Fault({Reason::kDriveStaysEnabled, enabled});
  } else {
    reason_ = Reason::kNone;
    where_ = kNone;
    Enter(MachineState::kIdle);
  }
}

void Transitions::ProgressReady(const Situation& now, Orders& orders) noexcept {
  if (!run_pending_ || orders.expect_path) return;
  if (now.path_prefetched) {
    run_pending_ = false;
    if (now.path_begins_here) {
      orders.start_path = true;
      reason_ = Reason::kNone;
      Enter(MachineState::kRunning);
    } else {
      // Refused, not faulted: the axes have not moved.
      reason_ = Reason::kPathDiscontinuous;
      orders.forget_path = true;
    }
  } else if (++run_pending_cycles_ > config_.prefetch_timeout_cycles) {
    run_pending_ = false;
    reason_ = Reason::kPathUnderrun;
    orders.forget_path = true;
  }
}

void Transitions::ProgressRunning(const Situation& now, Orders& orders) noexcept {
  if (now.path_at_end) {
    reason_ = Reason::kProgramEnd;
    Enter(MachineState::kReady);
  } else if (now.path_running_dry) {
    BeginStop(orders, {Reason::kPathUnderrun}, MachineState::kFaulted);
  }
}

void Transitions::ProgressStopping(const Situation& now, Orders& orders) noexcept {
  if (orders.stop_path) return;
  if (now.path_at_rest) {
    Enter(after_stop_);
  } else if (since_ > config_.stop_timeout_cycles) {
    Fault({Reason::kStopTimeout, 0xFF});
  }
}

DriveGoal Transitions::Goal() const noexcept {
  switch (state_) {
    case MachineState::kEnabling:
    case MachineState::kReady:
    case MachineState::kRunning:
    case MachineState::kStopping:
      return DriveGoal::kEnabled;
    case MachineState::kFaulted:
      // The drive's own ramp first; once it has let go, keep it without voltage.
      return drives_off_ ? DriveGoal::kDisabled : DriveGoal::kQuickStop;
    case MachineState::kIdle:
      return DriveGoal::kSwitchedOn;
    case MachineState::kStarting:
      return resetting_ ? DriveGoal::kFaultReset : DriveGoal::kDisabled;
    case MachineState::kOff:
      return DriveGoal::kDisabled;
  }
  return DriveGoal::kDisabled;
}

}  // namespace contour
