#pragma once

#include <cstdint>

#include "core/axis.h"
#include "core/cycle_input.h"
#include "core/reason.h"
#include "core/states.h"

namespace contour {

/// A fault seen in this cycle; the first one found wins.
struct FaultSeen {
  Reason reason = Reason::kNone;
  std::uint8_t where = 0xFF;  ///< axis, or bus for bus reasons; 0xFF the whole machine
  /// The drive's own ramp cannot be relied upon: its voltage goes off at once, the other axes stop by theirs.
  bool voltage_off = false;
};

/// What the machine's state depends on in one cycle.
struct Situation {
  Request request;
  IoInput io;
  bool bring_up_active = false;
  bool bring_up_failed = false;
  bool operational = false;  ///< all drives configured and Operational
  PerAxis<DriveState> drives;
  FaultSeen fault;  ///< acts whenever drives are or may be enabled
  FaultSeen lost;   ///< bus or drive lost: acts in every state but Off and Starting
  FaultSeen stop;   ///< leaves time for a stop on the path, which then ends in Faulted
  /// The drive of the machine's reason says that it lost its master.
  bool says_lost_master = false;
  std::uint8_t stuck = 0xFF;  ///< first drive whose transition has missed its deadline; 0xFF none
  FaultSeen second_master;  ///< another master on a bus: acts in every state but Off; a Faulted machine only
                            ///< falls silent
  std::uint8_t not_referenced = 0xFF;  ///< an axis that may run no program before it is told where it is
  std::uint8_t moves = 0xFF;           ///< an axis that is not at rest; 0xFF none
  bool can_reference = false;          ///< the request of this cycle tells an axis what can be true
  bool path_prefetched = false;
  bool path_begins_here = false;  ///< first point lies where the axes stand
  bool path_running_dry = false;
  bool path_at_end = false;
  bool path_at_rest = false;
};

/// What the state machine asks of the rest of the cycle.
struct Orders {
  bool start_bring_up = false;
  bool hold_here = false;    ///< take the measured position as reference, reset estimators and controller
  bool expect_path = false;  ///< of program_id
  bool start_path = false;
  bool stop_path = false;      ///< begin a stop on the path
  bool within_limits = false;  ///< it may take longer, so that every axis keeps its acceleration and jerk
  bool shorten_stop = false;   ///< of the stop under way: the shortest there is
  bool forget_path = false;    ///< hold where the reference stands
  bool reference = false;      ///< the axis of the request is where it says
  bool fall_silent = false;    ///< not a frame any more, until the next bring-up
  bool torque_allowed = false;
  bool finished = false;  ///< terminate is carried out
  DriveGoal goal = DriveGoal::kDisabled;
  std::uint8_t voltage_off = 0xFF;  ///< the axis whose goal is kDisabled whatever that of the others
};

/// Which machine state may follow which. A fault acts in the cycle that sees it; nothing but an enable
/// request leads to torque; a stop request is obeyed in every state that moves.
class Transitions {
 public:
  struct Config {
    std::uint32_t enable_timeout_cycles = 2000;
    std::uint32_t stop_timeout_cycles =
        2000;  ///< for a stop on the path and for drives to leave Operation Enabled
    std::uint32_t prefetch_timeout_cycles = 5000;  ///< from a run request to enough path points
    /// A drive takes so long to notice that its master is gone, and to be allowed to say so.
    std::uint32_t explain_cycles = 130;
  };
  explicit Transitions(const Config& config) : config_(config) {}

  Orders Step(const Situation& now) noexcept;
  /// A fault found after Step, by the torque guard: acts in this very cycle. Gives the orders that replace
  /// Step's.
  Orders RaiseLate(FaultSeen fault) noexcept;

  [[nodiscard]] MachineState state() const noexcept { return state_; }
  [[nodiscard]] Reason reason() const noexcept { return reason_; }
  [[nodiscard]] std::uint8_t reason_where() const noexcept { return where_; }
  [[nodiscard]] std::uint32_t acknowledged() const noexcept { return acknowledged_; }
  [[nodiscard]] bool acknowledged_ok() const noexcept { return acknowledged_ok_; }
  [[nodiscard]] std::uint32_t program_id() const noexcept { return program_id_; }
  /// Cycles spent in the present state.
  [[nodiscard]] std::uint32_t since() const noexcept { return since_; }
  /// Cycles that were spent in the state before.
  [[nodiscard]] std::uint32_t stayed() const noexcept { return stayed_; }
  [[nodiscard]] bool run_pending() const noexcept { return run_pending_; }
  [[nodiscard]] bool holds_torque() const noexcept {
    return state_ == MachineState::kReady || state_ == MachineState::kRunning ||
           state_ == MachineState::kStopping;
  }
  [[nodiscard]] bool drives_off() const noexcept { return drives_off_; }

 private:
  void Enter(MachineState next) noexcept;
  void Fault(FaultSeen fault) noexcept;
  void Acknowledge(const Request& request, bool ok) noexcept;
  void HandleRequest(const Situation& now, Orders& orders) noexcept;
  void Enable(const Situation& now, Orders& orders, const Request& request) noexcept;
  void Run(const Situation& now, Orders& orders, const Request& request) noexcept;
  void Reference(const Situation& now, Orders& orders) noexcept;
  void BeginStop(Orders& orders, FaultSeen why, MachineState after) noexcept;
  void StopFor(FaultSeen why, Orders& orders) noexcept;
  void SetGoals(Orders& orders) const noexcept;
  void BeginReset(Orders& orders) noexcept;
  void Progress(const Situation& now, Orders& orders) noexcept;
  void ProgressReady(const Situation& now, Orders& orders) noexcept;
  void ProgressRunning(const Situation& now, Orders& orders) noexcept;
  void ProgressStopping(const Situation& now, Orders& orders) noexcept;
  void ProgressStarting(const Situation& now, Orders& orders) noexcept;
  void WatchIo(const Situation& now, Orders& orders) noexcept;
  void Explain(const Situation& now) noexcept;
  [[nodiscard]] DriveGoal Goal() const noexcept;
  [[nodiscard]] bool SilentNow(const Situation& now) const noexcept;

  Config config_;
  MachineState state_ = MachineState::kOff;
  Reason reason_ = Reason::kNone;
  std::uint8_t where_ = 0xFF;
  MachineState after_stop_ = MachineState::kReady;
  std::uint32_t since_ = 0;
  std::uint32_t stayed_ = 0;
  std::uint32_t operational_ = 0;  ///< cycles in Starting since the drives are operational
  std::uint32_t acknowledged_ = 0;
  bool acknowledged_ok_ = false;
  std::uint32_t program_id_ = 0;
  bool run_pending_ = false;
  std::uint32_t run_pending_cycles_ = 0;
  bool terminating_ = false;
  bool reset_pending_ = false;  ///< asked for while the drives still stop
  Request reset_;
  bool resetting_ = false;  ///< Starting was asked for by an operator
  bool drives_off_ = true;
  bool voltage_off_ = false;  ///< of the last fault, at where_
};

/// Permission as the I/O gives it: kNone, or why not.
constexpr Reason IoVerdict(const IoInput& io) noexcept {
  if (!io.configured) return Reason::kNone;
  if (!io.fresh) return Reason::kIoStale;
  if (!io.emergency_stop_ok) return Reason::kEmergencyStop;
  if (!io.enable_chain_ok) return Reason::kEnableChainOpen;
  return Reason::kNone;
}

}  // namespace contour
