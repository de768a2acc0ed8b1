#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "control/contour_controller.h"
#include "control/motion_monitor.h"
#include "control/torque_guard.h"
#include "core/cycle_record.h"
#include "core/horizon.h"
#include "core/nonblocking.h"
#include "core/stage_sink.h"
#include "core/state_keeper.h"
#include "daemon/rt/cycle_config.h"
#include "daemon/rt/path_follower.h"
#include "daemon/rt/reason_watch.h"
#include "daemon/rt/self_watch.h"
#include "daemon/rt/transitions.h"
#include "drivers/cia301/bus_traffic.h"
#include "drivers/cia402/drive_master.h"
#include "estimator/axis_estimator.h"
#include "estimator/torque_in_period.h"

namespace contour {

/// One period of the machine, top to bottom: frames in, axis feedback, estimate, machine state, wanted
/// torque, torque limits, frames out, record. A pure function of its input and its state; the same in real
/// time, in virtual time and in replay.
class Cycle {
 public:
  /// Takes all memory there will be. Throws std::invalid_argument on a configuration that cannot run.
  explicit Cycle(const CycleConfig& config);

  /// `stages`, if any, is told how far the step has come; what is computed does not depend on it.
  void Step(const CycleInput& in, CycleOutput& out, StageSink* stages = nullptr) noexcept CONTOUR_NONBLOCKING;

  // Step in two parts, for a loop that sends the frames before it does the rest:
  /// All that the frames need; they and `finished` are in `out` then.
  void Act(const CycleInput& in, CycleOutput& out, StageSink* stages = nullptr) noexcept CONTOUR_NONBLOCKING;
  /// Everything else of `out`, of the same input.
  void Report(const CycleInput& in, CycleOutput& out) noexcept CONTOUR_NONBLOCKING;

  // For the loop around it:
  /// How many path points the next Step can take.
  [[nodiscard]] std::size_t PathRoom() const noexcept { return follower_.Room(); }
  /// For who supplies them.
  [[nodiscard]] PathProgress Progress() const noexcept { return follower_.progress(); }
  /// The drives have a SYNC to answer.
  [[nodiscard]] bool ExpectsFeedback() const noexcept { return master_.sync_sent(); }
  /// All drives' answers to the last SYNC are among these frames.
  [[nodiscard]] bool FeedbackComplete(const CycleInput& in) const noexcept;
  /// Nodes of the drives, bus by bus.
  [[nodiscard]] const FixedVector<BusNodes, kMaxBuses>& bus_nodes() const noexcept { return bus_nodes_; }
  /// Whether the frames of the cycle before left late: the cycle itself sees no clock. A replay tells it from
  /// the log.
  void TellLate(bool late) noexcept { late_ = late; }
  /// These frames must not wait, although nothing else is to be done: another master has come.
  [[nodiscard]] bool MustSee(const ReceivedFrames& frames) const noexcept {
    return master_.NewSecondMaster(frames);
  }
  /// The master's heartbeats alone, for a loop whose time stands still.
  void EncodeHeartbeat(CycleOutput& out) const noexcept;

  /// Other gains from the next Step on: takes the controller from `next`, with the memory of the present one,
  /// which it leaves there. False, and nothing has changed, when they are not of the same kind.
  bool TakeController(ContourController& next) noexcept CONTOUR_NONBLOCKING;

  // The state between two Steps, for a replay that does not begin at the start; see core/state_keeper.h.
  [[nodiscard]] std::size_t StateSize() noexcept;
  /// `to` has StateSize() bytes.
  void SaveState(std::span<std::byte> to) noexcept CONTOUR_NONBLOCKING;
  /// False when these bytes are not the state of such a cycle; it is then not to be used.
  bool LoadState(std::span<const std::byte> from) noexcept;

 private:
  struct Axis {
    Axis(const CycleConfig& config, std::size_t index, const MonitoredAxis& monitored);
    double radius_m_rad;
    AxisEstimator estimator;
    AxisEstimator observer;  ///< to fall back to
    KnownEffects known;
    MotionMonitor monitor;
    std::array<double, 3> sent_force_N{};  ///< newest first
    double reported_N = 0.0;               ///< torque at the sample before, as the drive told it
    TorqueInPeriod in_period;              ///< what it made of that, in csp
    std::size_t acts_after = 0;            ///< index into sent_force_N of what acted over the period
    double wanted_torque_Nm = 0.0;         ///< before the guard
    double position_m = 0.0;
    double blend_N = 0.0;          ///< what a change of controller must not make of the force, fading away
    double unreferenced_travel_m;  ///< 0: no programs before it is told where it is
    double following_error_m;
    double position_min_m;
    double position_max_m;
    double safe_travel_m;
    double speed_kept;                ///< per cycle
    double standing_m_s;              ///< an axis that is slower is at rest
    double speed_m_s = 0.0;           ///< of its readings, as slowly as the loop answers
    double seen_at_m = 0.0;           ///< the newest reading
    bool seen = false;                ///< there is one
    std::uint64_t unseen_cycles = 0;  ///< since that one
    double late_from_s;               ///< bit stuffing alone makes answers late by less
    double late_from_m;               ///< less is of the encoder's steps

    void Keep(StateKeeper& keep) noexcept {
      keep(estimator, observer, monitor, sent_force_N, reported_N, in_period, wanted_torque_Nm, position_m,
           blend_N, speed_m_s, seen_at_m, seen, unseen_cycles);
    }
  };

  using Feedback = PerAxis<AxisFeedback>;
  using Estimates = PerAxis<AxisEstimate>;

  void Keep(StateKeeper& keep) noexcept;

  // What Act is made of, in its order:
  const Feedback& Observe(const CycleInput& in) noexcept;
  [[nodiscard]] FaultSeen Contradiction(const Feedback& feedback) noexcept;
  void MeasureSpeed(Axis& axis, const AxisFeedback& feedback) noexcept;
  void TakeLateness(std::size_t index, const AxisFeedback& feedback) noexcept;
  [[nodiscard]] double TableAt_m(std::size_t index, const AxisFeedback& feedback) const noexcept;
  const Estimates& Estimate(const Feedback& feedback, const IoInput& io) noexcept;
  void WatchItself(const Feedback& feedback, const Estimates& estimate) noexcept;
  [[nodiscard]] Situation Assess(const CycleInput& in, const Estimates& estimate) const noexcept;
  void CarryOut(const Orders& orders, const Request& request) noexcept;
  const ControlOutput& Decide(const Orders& orders, const Estimates& estimate) noexcept;
  const PerAxis<GuardedTorque>& Limit(const ControlOutput& wanted, const Feedback& feedback,
                                      const FaultSeen& contradiction, const Request& request,
                                      Orders& orders) noexcept;
  void Send(const Orders& orders, const ControlOutput& wanted, const PerAxis<GuardedTorque>& limited,
            FixedVector<StampedFrame, kMaxFramesSentPerCycle>& frames) noexcept;

  [[nodiscard]] FaultSeen FindFault(const Estimates& estimate) const noexcept;
  [[nodiscard]] FaultSeen FindLost(const CycleInput& in) const noexcept;
  [[nodiscard]] FaultSeen FindStop() const noexcept;
  [[nodiscard]] std::uint8_t FindStuck() const noexcept;
  [[nodiscard]] bool Acts(Watch watch) const noexcept { return off_.Acts(watch); }
  [[nodiscard]] bool PathBeginsHere() const noexcept;
  [[nodiscard]] bool CanReference(const Request& request) const noexcept;
  [[nodiscard]] std::uint8_t NotReferenced() const noexcept;
  [[nodiscard]] std::uint8_t MovingAxis() const noexcept;
  void TellWhere(const Request& request) noexcept;
  void DoubtPosition(const Orders& orders) noexcept;
  /// Nothing was sent at the skipped grid points, so the newest feedback is that much older, and the last
  /// torque has acted on since.
  [[nodiscard]] const ReferencePoint& AtSample(std::size_t axis) noexcept {
    if (skipped_ == 0) return control_in_.reference[axis][0];
    return at_sample_ = follower_.Near(axis, -static_cast<int>(skipped_));
  }
  void CatchUp(Axis& axis, std::size_t index, AxisEstimatorInput input) noexcept;
  void HoldHere() noexcept;
  void FollowFeedback() noexcept;
  void TellStatedForces() noexcept;
  void Blend() noexcept;
  void TellLoop() noexcept;
  [[nodiscard]] bool fallen_back() const noexcept {
    return fallback_ != nullptr && watch_.step() >= SupervisionStep::kFallenBack;
  }
  [[nodiscard]] ContourController& controller() noexcept { return fallen_back() ? *fallback_ : controller_; }
  FaultSeen Guard(const ControlOutput& wanted, const Feedback& feedback, bool torque_allowed) noexcept;
  void RecordContourError(CycleRecord& record) noexcept;
  void RecordAxis(std::size_t i, AxisRecord& record) noexcept;

  double period_s_;
  std::size_t axis_count_;  ///< what axes_.size() would divide for, in every loop
  DriveMaster master_;
  std::vector<Axis> axes_;
  Transitions transitions_;
  ReasonWatch reasons_;
  PathFollower follower_;
  ContourController controller_;
  std::unique_ptr<ContourController> fallback_;  // none: there is nothing to fall back to
  SelfWatch watch_;
  SupervisionStep acted_ =
      SupervisionStep::kNone;  ///< the ladder's step that controllers and estimators know of
  bool take_over_ = false;     ///< the next force comes from another controller than the last
  bool late_ = false;
  double blend_kept_ = 0.0;  // per cycle
  TorqueGuard guard_;
  bool csp_;
  bool same_law_;  ///< a softened loop is the same one: nothing takes over
  bool
      by_reported_torque_;  ///< the estimators are told what the drives report instead of what they were sent
  bool two_inertias_;       ///< motor and table are known apart; so is when a linear scale is silent
  WatchesOff off_;          ///< none, but in tests
  std::uint32_t most_skipped_;  ///< an axis in motion may go without control for fewer periods than this
  std::uint32_t skipped_ = 0;   ///< grid points just before this one at which nothing was sent

  ReferencePoint at_sample_;          ///< what AtSample gives, until the next
  std::uint32_t skipped_before_ = 0;  ///< in the cycle before: a SYNC was left out before the newest sample
  PerAxis<AxisEstimate> estimates_;
  ControlInput control_in_;
  ControlOutput control_out_;
  PerAxis<GuardedTorque> guarded_;
  PerAxis<AxisSetpoint> setpoints_;
  PerAxis<double> near_position_m_;
  PerAxis<AxisHorizon> near_path_;
  std::uint64_t stale_cycles_ = 0;
  FixedVector<StampedFrame, kMaxAxes> answers_;  ///< bus and identifier of each drive's answer to SYNC
  FixedVector<StampedFrame, kMaxBuses> heartbeats_;
  FixedVector<BusNodes, kMaxBuses> bus_nodes_;
  std::vector<std::byte> handover_;  ///< room for a controller's memory
};

}  // namespace contour
