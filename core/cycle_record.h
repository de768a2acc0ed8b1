#pragma once

#include <cstdint>

#include "core/axis.h"
#include "core/cycle_input.h"
#include "core/late_cause.h"
#include "core/reason.h"
#include "core/reference.h"
#include "core/states.h"

namespace contour {

/// Where the drives' bring-up stands, for status lines and error messages.
struct BringUpStatus {
  std::uint8_t phase = 0;  ///< BringUpPhase of drivers/cia301/bring_up.h
  std::uint8_t axis = 0;   ///< axis at work, or the one that failed
  std::uint8_t node_id = 0;
  std::uint8_t error = 0;   ///< BringUpError of drivers/cia301/bring_up.h; 0 none
  std::uint16_t index = 0;  ///< object at work
  std::uint8_t sub_index = 0;
  std::uint32_t abort_code = 0;  ///< SDO abort code, when the error is one
  std::uint32_t expected = 0;    ///< for mismatches
  std::uint32_t found = 0;
  std::uint32_t waited_us = 0;
};

/// One axis in one cycle. Feedback, reference and estimate belong to the same instant, the SYNC at which the
/// feedback was latched; the torques are the command computed from it.
struct AxisRecord {
  AxisFeedback feedback;
  ReferencePoint reference;  ///< motion at the feedback's instant; extra torque and spring of torque_Nm
  AxisEstimate estimate;
  double position_m = 0.0;           ///< R theta of the feedback
  double following_error_m = 0.0;    ///< reference minus position
  double feedforward_Nm = 0.0;       ///< model and friction feed-forward inside wanted_torque
  double wanted_torque_Nm = 0.0;     ///< before the guard
  double torque_Nm = 0.0;            ///< sent
  double target_position_rad = 0.0;  ///< sent, in CSP
  DriveGoal goal = DriveGoal::kDisabled;
  Reason limit = Reason::kNone;
  std::uint16_t emergency_code = 0;  ///< last EMCY error code of this node, 0 none
  // Not in the log: a replay computes it again.
  ReferenceState reference_state = ReferenceState::kAbsolute;
  double travel_min_m = 0.0;  ///< where a program may take it: its limits, or around where it was enabled
  double travel_max_m = 0.0;
};

/// What a drive said in the cycle in which the reason arose, for the reason's text; later cycles do not
/// change it. It is not in the log: a replay finds it again.
struct ReasonDetail {
  DriveState drive_state = DriveState::kUnknown;
  std::uint16_t emergency_code = 0;     ///< the one that led to it, or the first soon after
  std::uint64_t waited_us = 0;          ///< how long was waited in vain; 0 where nothing was waited for
  std::uint8_t slow_quick_stop = 0xFF;  ///< axis whose quick stop did not end in time afterwards; 0xFF none
  std::uint64_t slow_quick_stop_us = 0;
};

/// All that is known of one cycle; telemetry, logs, status and replay share it.
struct CycleRecord {
  std::uint64_t cycle = 0;
  std::int64_t grid_time_ns = 0;
  std::uint64_t sync_number = 0;    ///< SYNCs sent including this cycle's; 0 before the first
  std::uint64_t feedback_sync = 0;  ///< number of the SYNC that latched the feedback; 0 none
  MachineState state = MachineState::kOff;
  Reason reason = Reason::kNone;    ///< of the last stop or fault
  std::uint8_t reason_axis = 0xFF;  ///< axis (or bus, for bus reasons) concerned; 0xFF none
  ReasonDetail reason_detail;
  std::uint32_t acknowledged = 0;  ///< sequence of the last request acted on or refused
  bool acknowledged_ok = false;    ///< false: refused in this state
  std::uint32_t program_id = 0;    ///< of the program that runs or ran last
  double path_time_s = 0.0;        ///< position on the program's time axis, of the feedback's instant
  double pace = 0.0;               ///< program time per time; 1 as programmed, 0 paused. Not in the log
  std::uint32_t program_line = 0;  ///< of its text; 0 unknown. Not in the log
  double contour_error_m = 0.0;    ///< seen at the encoder; shortest distance to the path nearby
  double lag_error_m = 0.0;        ///< along the path, positive behind
  std::uint16_t path_points_waiting = 0;
  std::uint16_t solver_iterations = 0;
  std::uint64_t stale_cycles = 0;  ///< since start
  IoInput io;
  BringUpStatus bring_up;
  PerAxis<AxisRecord> axes;
};

/// Stage stamps of one cycle on the loop's clock, and what the kernel counted, taken by the loop around the
/// cycle, never seen by it. All zero in virtual time.
struct CycleTiming {
  std::int64_t wakeup_late_ns = 0;  ///< woken minus grid point
  std::int64_t received_ns = 0;     ///< since the grid point
  std::int64_t stepped_ns = 0;
  std::int64_t sent_ns = 0;
  bool late = false;
  std::uint32_t skipped_grid_points = 0;
  std::int64_t estimated_ns = 0;  ///< since the grid point, as above: estimators updated
  std::int64_t decided_ns = 0;    ///< controller done
  LateCause cause = LateCause::kNone;
  // From the frames of the cycle before to those of this one:
  std::int64_t after_send_ns = 0;  ///< from the frames of the cycle before to going to sleep
  std::int64_t run_delay_ns = 0;   ///< ready to run but not running
  std::uint32_t page_faults = 0;
  std::uint32_t involuntary_switches = 0;
  std::uint32_t voluntary_switches = 0;  ///< besides the sleep until the grid point
};

inline constexpr std::size_t kMaxFramesSentPerCycle = 64;

/// What the cycle gives back.
struct CycleOutput {
  FixedVector<StampedFrame, kMaxFramesSentPerCycle> frames;  ///< in sending order: RPDOs, then SYNC per bus
  CycleRecord record;
  bool finished = false;   ///< terminate was carried out: the loop may end
  bool quiescent = false;  ///< nothing to do until a request comes (lock-step time may stand still)
  bool settling =
      false;  ///< will be quiescent soon; virtual and lock-step time hold requests back until then
};

/// One entry of the telemetry queue: everything about one cycle, inputs included.
struct CycleEntry {
  CycleInput input;
  CycleOutput output;
  CycleTiming timing;
};

}  // namespace contour
