#include "daemon/rt/cycle.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

// What this cycle finds: of drives, buses, paths and requests. What follows from it stands in transitions.cc.
namespace contour {
namespace {

/// A program begins where the axes stand; more than this away and it is refused.
constexpr double kPathStartTolerance_m = 1e-6;

}  // namespace

Situation Cycle::Assess(const CycleInput& in, const Estimates& estimate) const noexcept {
  Situation now;
  now.request = in.request;
  now.io = in.io;
  now.operational = master_.operational();
  now.bring_up_failed = master_.bring_up_failed();
  now.bring_up_active = master_.BringingUp();
  for (const AxisFeedback& f : master_.feedback()) now.drives.push_back(f.drive_state);
  now.fault = FindFault(estimate);
  now.lost = FindLost(in);
  now.stop = FindStop();
  now.stuck = FindStuck();
  if (const std::uint8_t where = transitions_.reason_where(); where < axis_count_)
    now.says_lost_master = master_.status()[where].lost_master && Acts(Watch::kDriveLostMaster);
  if (const std::uint8_t bus = master_.second_master();
      bus != DriveMaster::kNoBus && Acts(Watch::kSecondMaster))
    now.second_master = {Reason::kSecondMaster, bus};
  now.not_referenced = NotReferenced();
  if (!transitions_.holds_torque()) {
    now.moves = MovingAxis();
    now.bring_up_active = now.bring_up_active || master_.ProbesAnswers();
  }
  now.can_reference = CanReference(in.request);
  now.path_prefetched = follower_.Prefetched();
  now.path_begins_here = now.path_prefetched && PathBeginsHere();
  now.path_running_dry = follower_.running_dry();
  now.path_at_end = follower_.at_end();
  now.path_at_rest = follower_.at_rest();
  return now;
}

FaultSeen Cycle::FindFault(const Estimates& estimate) const noexcept {
  const MachineState state = transitions_.state();
  if (skipped_ >= most_skipped_ && follower_.moving() && Acts(Watch::kGridPointsSkipped))
    return {Reason::kGridPointsSkipped, 0xFF};
  for (std::size_t i = 0; i < axis_count_; ++i) {
    const auto where = static_cast<std::uint8_t>(i);
    const AxisDriveStatus& status = master_.status()[i];
    // Why it stopped says more than that it did.
    if (status.lost_master && Acts(Watch::kDriveLostMaster)) return {Reason::kDriveLostMaster, where};
    if (status.fault && Acts(Watch::kDriveFault)) return {Reason::kDriveFault, where};
    if (status.emergency >= EmergencyReaction::kQuickStop && Acts(Watch::kDriveEmergency))
      return {Reason::kDriveEmergency, where, status.emergency == EmergencyReaction::kVoltageOff};
    if (state != MachineState::kEnabling && status.left_enabled && Acts(Watch::kDriveLeftEnabled))
      return {Reason::kDriveLeftEnabled, where};
    if (status.mode_changed && Acts(Watch::kModeChanged)) return {Reason::kModeChanged, where};
    if (status.not_following && Acts(Watch::kDriveNotFollowing)) return {Reason::kDriveNotFollowing, where};
    // Before the torque is allowed the guard does not look, and the drives hold already.
    if (state == MachineState::kEnabling && master_.feedback()[i].age_cycles >= most_skipped_ &&
        Acts(Watch::kStaleFeedback))
      return {Reason::kStaleFeedback, where};
    if (estimate[i].diverged) return {Reason::kEstimatorDiverged, where};
  }
  return watch_.Fault();
}

FaultSeen Cycle::FindLost(const CycleInput& in) const noexcept {
  for (std::size_t b = 0; b < in.buses.size(); ++b) {
    const auto where = static_cast<std::uint8_t>(b);
    if (in.buses[b].bus_off && Acts(Watch::kBusDown)) return {Reason::kBusOff, where};
    if (!in.buses[b].up && Acts(Watch::kBusDown)) return {Reason::kBusDown, where};
    if (in.buses[b].send_failures != 0 && Acts(Watch::kSendFailed)) return {Reason::kSendFailed, where};
  }
  for (std::size_t i = 0; i < axis_count_; ++i) {
    const auto where = static_cast<std::uint8_t>(i);
    const AxisDriveStatus& s = master_.status()[i];
    const bool left_operational = s.configured && s.nmt != NmtState::kOperational;
    if (s.restarted && Acts(Watch::kDriveRestarted)) return {Reason::kDriveRestarted, where};
    if (s.lost_master && left_operational && Acts(Watch::kDriveLostMaster))
      return {Reason::kDriveLostMaster, where};
    if (s.heartbeat_lost && Acts(Watch::kHeartbeatLost)) return {Reason::kHeartbeatLost, where};
    if (s.answers != AnswerFault::kNone && Acts(Watch::kDriveLeftOperational))
      return {s.answers == AnswerFault::kLate ? Reason::kAnswersLate : Reason::kNodeAnswersTwice, where};
    if (s.stays_enabled && Acts(Watch::kDriveLeftEnabled)) return {Reason::kDriveStaysEnabled, where};
    if (left_operational && Acts(Watch::kDriveLeftOperational)) return {Reason::kDriveLeftOperational, where};
  }
  return {};
}

FaultSeen Cycle::FindStop() const noexcept {
  for (std::size_t i = 0; i < axis_count_; ++i)
    if (master_.status()[i].emergency == EmergencyReaction::kStopOnPath && Acts(Watch::kDriveEmergency))
      return {Reason::kDriveEmergency, static_cast<std::uint8_t>(i)};
  // The axis goes on by its motor alone: there is time to stop on the path.
  for (std::size_t i = 0; i < axis_count_; ++i)
    if (estimates_[i].scale != Reason::kNone && Acts(Watch::kScale))
      return {estimates_[i].scale, static_cast<std::uint8_t>(i)};
  return watch_.Stop();
}

std::uint8_t Cycle::FindStuck() const noexcept {
  for (std::size_t i = 0; i < axis_count_; ++i)
    if (master_.status()[i].transition_late) return static_cast<std::uint8_t>(i);
  return 0xFF;
}

bool Cycle::PathBeginsHere() const noexcept {
  const PathPoint& first = follower_.First();
  if (first.axes.size() != axis_count_) return false;
  for (std::size_t i = 0; i < axis_count_; ++i)
    if (!(std::abs(first.axes[i].position_m - control_in_.reference[i][0].position_m) <=
          kPathStartTolerance_m))
      return false;
  return true;
}

// Of an axis that knew where it is, or moved, and does not any more, no program can be right. One that was
// never told may move as far as the operator says.
std::uint8_t Cycle::NotReferenced() const noexcept {
  for (std::size_t i = 0; i < axis_count_; ++i) {
    const ReferenceState state = master_.reference(i);
    const bool may_move =
        IsReferenced(state) || (state == ReferenceState::kNeverTold && axes_[i].unreferenced_travel_m > 0.0);
    if (!may_move) return static_cast<std::uint8_t>(i);
  }
  return 0xFF;
}

// One that its loop would brake by more than its limit of acceleration does not stand.
std::uint8_t Cycle::MovingAxis() const noexcept {
  for (std::size_t i = 0; i < axis_count_; ++i)
    if (std::abs(axes_[i].speed_m_s) > axes_[i].standing_m_s) return static_cast<std::uint8_t>(i);
  return 0xFF;
}

bool Cycle::CanReference(const Request& request) const noexcept {
  if (request.kind != RequestKind::kReference) return false;
  const ReferenceRequest told = DecodeReference(request.program_id);
  if (!master_.CanTellPosition(told.axis)) return false;
  // A stop may have left it beyond its limits: from there it is driven back.
  const Axis& axis = axes_[told.axis];
  return told.position_m >= axis.position_min_m - axis.safe_travel_m &&
         told.position_m <= axis.position_max_m + axis.safe_travel_m;
}

}  // namespace contour
