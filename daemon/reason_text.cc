#include "daemon/reason_text.h"

#include "daemon/rt/transitions.h"
#include "drivers/cia301/bring_up_text.h"
#include "drivers/cia301/emergency_table.h"

namespace contour {
namespace {

std::string Hex(unsigned value) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::string text = "0x0000";
  for (std::size_t i = 0; i < 4; ++i) text[5 - i] = kDigits[(value >> (4 * i)) & 0xF];
  return text;
}

std::string EmergencyOf(std::uint16_t code) {
  return "emergency code " + Hex(code) + " (" + std::string(EmergencyText(code)) + ")";
}

/// What the drive said when the reason arose.
std::string DriveText(const ReasonDetail& detail) {
  std::string text = ", drive in state " + std::string(Name(detail.drive_state));
  if (detail.emergency_code != 0) text += ", " + EmergencyOf(detail.emergency_code);
  return text;
}

std::string Milliseconds(std::uint64_t time_us) { return std::to_string((time_us + 500) / 1000) + " ms"; }

/// A drive that heard nobody stopped by itself, and says so.
std::string SaidByDrives(const CycleRecord& record, std::span<const std::string> axis_names) {
  std::string text;
  for (std::size_t i = 0; i < record.axes.size() && i < axis_names.size(); ++i)
    if (record.axes[i].emergency_code != 0)
      text += "; axis " + axis_names[i] + " sent " + EmergencyOf(record.axes[i].emergency_code);
  return text;
}

/// Of the axis that the reason is about.
bool VoltageIsOff(const CycleRecord& record) {
  return record.state == MachineState::kFaulted && record.reason_axis < record.axes.size() &&
         record.axes[record.reason_axis].goal == DriveGoal::kDisabled;
}

std::string WhyText(const CycleRecord& record, std::span<const std::string> axis_names,
                    std::span<const std::string> bus_names) {
  const std::uint8_t at = record.reason_axis;
  const ReasonDetail& detail = record.reason_detail;
  const std::string axis = at < axis_names.size() ? "axis " + axis_names[at] : "a drive";
  const std::string bus = at < bus_names.size() ? "bus " + bus_names[at] : "a bus";
  switch (record.reason) {
    case Reason::kNone:
      return {};
    case Reason::kOperatorStop:
      return "stopped on the path as asked";
    case Reason::kTerminate:
      return "the daemon was asked to end: stopped on the path and switched off";
    case Reason::kProgramEnd:
      return "the program has ended";
    case Reason::kDisableRequest:
      return "switched off as asked";
    case Reason::kStaleFeedback:
      return axis + " sent no position for several cycles; quick stop. Check the drive's supply and the bus" +
             DriveText(detail);
    case Reason::kFollowingError:
      return axis +
             " left the reference by more than limits.following_error_mm; quick stop. Look for a collision, "
             "a wrong "
             "model, or limits too tight for this feed";
    case Reason::kPositionLimit:
      return axis + " is outside limits.position_mm; quick stop. Move it back by hand with the drive off";
    case Reason::kVelocityLimit:
      return axis + " ran faster than its limit allows; quick stop";
    case Reason::kNotANumber:
      return axis +
             ": the torque computed was no number; zero torque and quick stop. Please report this with the "
             "log";
    case Reason::kBusDown:
      return bus + " is down; the drives stop by themselves. Bring the interface up, then reset";
    case Reason::kBusOff:
      return bus +
             " is bus-off: the controller saw too many errors. Check wiring, termination and bit rate, then "
             "reset";
    case Reason::kSendFailed:
      return bus +
             " did not take the frames of a cycle (transmit queue full or interface gone); raise txqueuelen, "
             "check the "
             "bus, then reset";
    case Reason::kHeartbeatLost:
      return axis + ": neither heartbeat nor position of the drive" +
             (detail.waited_us == 0 ? std::string() : " for " + Milliseconds(detail.waited_us)) +
             " (drive.heartbeat_timeout_ms); quick stop. Check its supply and the bus, then reset" +
             DriveText(detail);
    case Reason::kDriveFault:
      return axis + ": the drive reports a fault" + DriveText(detail) +
             "; see its manual for the code, then reset";
    case Reason::kDriveLeftEnabled:
      return axis + ": the drive left Operation Enabled by itself" + DriveText(detail) + "; then reset";
    case Reason::kEmergencyStop:
      return "the emergency-stop input is open; quick stop. Release it, then reset";
    case Reason::kEnableChainOpen:
      return "the enable chain is open; stopped on the path and switched off. Close it, then reset";
    case Reason::kIoStale:
      return "no fresh data from the Modbus I/O; stopped on the path and switched off. Check the I/O "
             "station, then reset";
    case Reason::kBringUpFailed:
      return "a drive could not be brought up";
    case Reason::kPathUnderrun:
      return "the supply of path points ran dry; stopped on the path. The host is overloaded; reset and run "
             "again";
    case Reason::kPathDiscontinuous:
      return "the program does not begin where the axes stand; nothing was moved. Run it again";
    case Reason::kEnableTimeout:
      return axis + ": the drive did not reach Operation Enabled, it stayed in " +
             std::string(Name(detail.drive_state)) +
             (detail.waited_us == 0 ? std::string() : " for " + Milliseconds(detail.waited_us)) +
             " (drive.transition_ms)" +
             (detail.emergency_code == 0 ? std::string() : ", " + EmergencyOf(detail.emergency_code)) +
             ". Look for a missing power stage, an open enable or safe-torque-off input";
    case Reason::kStopTimeout:
      return "a stop on the path did not come to rest within " + Milliseconds(detail.waited_us) +
             " (the ramp by limits.acceleration_mm_s2 and limits.jerk_mm_s3, and drive.quick_stop_ms); quick "
             "stop";
    case Reason::kEstimatorDiverged:
      return axis + ": the friction estimate diverged; quick stop. Please report this with the log";
    case Reason::kGridPointsSkipped:
      return "no cycle ran" +
             (detail.waited_us == 0 ? std::string() : " for " + Milliseconds(detail.waited_us)) +
             " while the axes moved; quick stop. contourd was stopped (SIGSTOP, a debugger), or the host is "
             "overloaded or gives no real time: `contour status --json` counts why, late.causes" +
             SaidByDrives(record, axis_names) + "; then reset";
    case Reason::kDriveNotFollowing:
      return axis +
             ": the enabled drive does not say that it follows its target (bit 12 of the statusword), or "
             "not any more that it obeys its controlword (bit 9); quick stop. Look for a limit, a halt or "
             "another mode in the drive, and for somebody who has taken it over (its panel, its maker's "
             "program). For a drive whose bits 12 and 9 do not say so set drive.follows_target_bit: false; "
             "then neither is watched" +
             DriveText(detail);
    case Reason::kFeedbackFrozen:
      return axis +
             ": the position stands still although the axis must move; voltage off, since the encoder cannot "
             "be believed. Check encoder, its cable and the coupling, and that no brake holds";
    case Reason::kFeedbackJump:
      return axis +
             ": the position jumped further than any force can take it; voltage off, since the encoder "
             "cannot be believed. Check encoder and cable, then reset and reference the axis anew";
    case Reason::kFeedbackReversed:
      return axis +
             ": the position moves against the torque; voltage off. Check the signs of encoder and torque "
             "(0x607E) and the motor's phases";
    case Reason::kTorqueWithoutMotion:
      return axis +
             ": more torque than friction and outside forces explain moves nothing; voltage off. Look for a "
             "collision, a closed brake, a torn coupling, or a drive without power" +
             DriveText(detail);
    case Reason::kTorqueNotDelivered:
      return axis +
             ": the drive reports another torque than it was sent; voltage off. Look for a limit in the "
             "drive, its supply, or a lost phase" +
             DriveText(detail);
    case Reason::kScaleDisagrees:
      return axis +
             ": linear scale and motor differ by more than the screw can wind up; voltage off. Check scale, "
             "read head and coupling";
    case Reason::kScaleLost:
      return axis +
             ": the linear scale in the loop is silent; the motor's encoder held the axis, and the machine "
             "stopped on the path. Check read head, cable and TPDO2, then reset";
    case Reason::kScaleDoubted:
      return axis +
             ": motor and torque contradict the linear scale in the loop; the motor's encoder held the axis, "
             "and the machine stopped on the path. Check scale, read head, coupling and counts_per_mm, then "
             "reset";
    case Reason::kModeChanged:
      return axis +
             ": the drive left the mode of operation that was set (0x6061); quick stop. Look for another "
             "program that writes to the drive";
    case Reason::kDriveRestarted:
      return axis + ": the drive restarted (boot-up message). Check its supply, then reset" +
             DriveText(detail);
    case Reason::kDriveLeftOperational:
      return axis +
             ": the drive left Operational, so it takes no set-points any more. Look for another master, "
             "then reset" +
             DriveText(detail);
    case Reason::kDriveLostMaster:
      return axis +
             ": the drive says that it lost the master (heartbeat, SYNC or set-points). Check the bus and "
             "the host's load, then reset" +
             DriveText(detail);
    case Reason::kDriveEmergency:
      return axis + ": the drive sent " + EmergencyOf(detail.emergency_code) +
             "; the machine stopped. Mend what it names, then reset";
    case Reason::kSecondMaster:
      return bus + ": another master sends on this bus" +
             (SecondMasterText(record.bring_up).empty() ? std::string()
                                                        : ", seen by " + SecondMasterText(record.bring_up)) +
             "; ours stopped the drives and is silent now. Only one may command them: end the other, then "
             "reset";
    case Reason::kOscillation:
      return axis + ": the loop oscillates; " + (VoltageIsOff(record) ? "voltage off" : "stopped") +
             ". Check model and tuning, and whether the table carries more than the model states";
    case Reason::kEstimatorInconsistent:
      return axis +
             ": the estimator's innovations have long been larger than it says; stopped on the path. The "
             "model does not fit this axis: identify it again";
    case Reason::kSolverCapLasting:
      return "the controller's solver has long not come to its end within a cycle; stopped on the path";
    case Reason::kCyclesLate:
      return "too many cycles in a row were late; stopped on the path. The host is overloaded or gives no "
             "real time";
    case Reason::kNotReferenced:
      return axis +
             (at < record.axes.size() && record.axes[at].reference_state == ReferenceState::kNeverTold
                  ? " was never told where it is, and limits.unreferenced_travel_mm states no travel for that"
                  : " does not know any more where it is: its drive restarted, was out of reach, or gave "
                    "positions that cannot be") +
             "; disable the machine and tell it (contour reference " +
             (at < axis_names.size() ? axis_names[at] : "AXIS") + "=MM), then run the program";
    case Reason::kDriveStaysEnabled:
      return axis +
             ": the drive stays in Operation Enabled although it was told to leave it (drive.quick_stop_ms, "
             "drive.transition_ms); it got NMT stop. Look for another master, or a drive that is commanded "
             "by its terminals, then reset" +
             DriveText(detail);
    case Reason::kNodeAnswersTwice:
      return axis +
             ": more answers to SYNC come under this node number than SYNCs are sent; quick stop. Two drives "
             "have the same node number: give each its own, then reset";
    case Reason::kAxisMoves:
      return axis +
             " is not at rest; it was not enabled. Wait until it stands, then enable again; one that falls "
             "or swings on needs its brake closed while the drive is off";
    case Reason::kAnswersLate:
      return axis +
             ": the drive's answers to SYNC (TPDO1) come later than a cycle, so every position is that of a "
             "SYNC before the one it would be taken for; not enabled. See that its TPDO1 has transmission "
             "type 1 and no inhibit time, that the bus is not full (contour check), or state a longer "
             "machine.cycle_us; then reset";
    case Reason::kTorqueLimit:
    case Reason::kTorqueRateLimit:
    case Reason::kSolverCap:
    case Reason::kInnovationGated:
    case Reason::kParameterBound:
    case Reason::kTorqueConstantChanged:
    case Reason::kOscillationNoticed:
    case Reason::kSoftened:
    case Reason::kFallenBack:
    case Reason::kEmergencyNoticed:
    case Reason::kForeignSdo:
      return std::string(Name(record.reason));
  }
  return {};
}

}  // namespace

std::string ReasonText(const CycleRecord& record, std::span<const std::string> axis_names,
                       std::span<const std::string> bus_names) {
  const std::string text = WhyText(record, axis_names, bus_names);
  const ReasonDetail& detail = record.reason_detail;
  if (text.empty() || detail.slow_quick_stop >= axis_names.size()) return text;
  return text + ". Axis " + axis_names[detail.slow_quick_stop] + " did not end its quick stop within " +
         Milliseconds(detail.slow_quick_stop_us) + " (drive.quick_stop_ms): its voltage was taken away";
}

std::string RefusalText(const CycleRecord& record, RequestKind request,
                        std::span<const std::string> axis_names, std::span<const std::string> bus_names) {
  const std::string state = "the machine is " + std::string(Name(record.state));
  if (request == RequestKind::kTune)
    return "the running controller cannot take these gains and keeps its own; restart contourd to use them";
  if (record.state == MachineState::kFaulted)
    return state + " (" + ReasonText(record, axis_names, bus_names) + "); reset it first";
  switch (request) {
    case RequestKind::kEnable: {
      CycleRecord io = record;
      io.reason = IoVerdict(record.io);
      if (record.state == MachineState::kIdle && io.reason != Reason::kNone)
        return "not permitted: " + ReasonText(io, axis_names, bus_names);
      if (record.state == MachineState::kIdle && record.reason == Reason::kAxisMoves)
        return ReasonText(record, axis_names, bus_names);
      return state + "; only an Idle machine can be enabled";
    }
    case RequestKind::kReference:
      return state + (record.state == MachineState::kIdle
                          ? "; an axis can be told where it is once its position is known, within its limits"
                          : "; an axis is told where it is while the machine is Idle: disable it first");
    case RequestKind::kRun:
      if (record.state == MachineState::kReady && record.reason == Reason::kNotReferenced)
        return ReasonText(record, axis_names, bus_names);
      return state + "; a program starts only from Ready" +
             (record.state == MachineState::kIdle ? ": enable the machine first" : "");
    case RequestKind::kReset:
      return state + "; there is nothing to reset";
    default:
      return state;
  }
}

}  // namespace contour
