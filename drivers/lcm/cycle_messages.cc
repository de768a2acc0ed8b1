#include "drivers/lcm/cycle_messages.h"

#include <algorithm>
#include <iterator>
#include <type_traits>
#include <vector>

namespace contour {
namespace {

/// Direction core -> message.
struct Writing {
  template <class Core, class Wire>
  void operator()(const Core& core, Wire& wire) {
    wire = static_cast<Wire>(core);
  }
  template <class Core, std::size_t N, class Count, class Wire, class Fields>
  void List(const FixedVector<Core, N>& core, Count& count, std::vector<Wire>& wire, Fields fields) {
    count = static_cast<Count>(core.size());
    wire.resize(core.size());
    for (std::size_t i = 0; i < core.size(); ++i) fields(*this, core[i], wire[i]);
  }
  void Bytes(const CanFrame& frame, std::uint8_t (&bytes)[8]) {
    std::copy(frame.data.begin(), frame.data.end(), std::begin(bytes));
  }
};

/// Direction message -> core.
struct Reading {
  bool fits = true;

  template <class Core, class Wire>
  void operator()(Core& core, const Wire& wire) {
    core = static_cast<Core>(wire);
  }
  template <class Core, std::size_t N, class Count, class Wire, class Fields>
  void List(FixedVector<Core, N>& core, const Count&, const std::vector<Wire>& wire, Fields fields) {
    if (wire.size() > N) {
      fits = false;
      return;
    }
    core.resize(wire.size());
    for (std::size_t i = 0; i < core.size(); ++i) fields(*this, core[i], wire[i]);
  }
  void Bytes(CanFrame& frame, const std::uint8_t (&bytes)[8]) {
    std::copy(std::begin(bytes), std::end(bytes), frame.data.begin());
  }
};

// Each of these names every field of a struct once. In the direction of writing the core side is const, in
// the direction of reading the message is.

struct FrameFields {
  void operator()(auto& copy, auto& core, auto& wire) const {
    copy(core.stamp_ns, wire.stamp_ns);
    copy(core.frame.id, wire.id);
    copy(core.bus, wire.bus);
    copy(core.frame.length, wire.length);
    copy.Bytes(core.frame, wire.data);
  }
};

struct ReferenceFields {
  void operator()(auto& copy, auto& core, auto& wire) const {
    copy(core.position_m, wire.position_m);
    copy(core.velocity_m_s, wire.velocity_m_s);
    copy(core.acceleration_m_s2, wire.acceleration_m_s2);
    copy(core.extra_torque_Nm, wire.extra_torque_Nm);
    copy(core.spring_N_m, wire.spring_N_m);
  }
};

/// What a path point says besides its axes travels in one entry behind them, so that the type of the message,
/// and with it every older log, stays readable: bit 32 of program_id says that it is there.
struct PathPointFields {
  static constexpr std::int64_t kMarked = std::int64_t{1} << 32;

  void operator()(Writing& copy, const PathPoint& core, contour_lcm::path_point& wire) const {
    copy.List(core.axes, wire.num_axes, wire.axes, ReferenceFields{});
    wire.program_id = core.program_id | kMarked;
    wire.last = core.last;
    const bool told = core.index != PathPoint::kNextIndex;
    contour_lcm::reference_point& mark = wire.axes.emplace_back();
    mark.position_m = core.program_time_s;
    mark.velocity_m_s = told ? static_cast<double>(core.index) : -1.0;
    mark.acceleration_m_s2 = core.law;
    mark.extra_torque_Nm = core.line;
    mark.spring_N_m = 0.0;
    ++wire.num_axes;
  }
  void operator()(Reading& copy, PathPoint& core, const contour_lcm::path_point& wire) const {
    copy(core.program_id, wire.program_id);
    copy(core.last, wire.last);
    core.index = PathPoint::kNextIndex;
    core.law = core.line = 0;
    core.program_time_s = PathPoint::kOwnPace;
    if ((wire.program_id & kMarked) == 0 || wire.axes.empty()) {
      copy.List(core.axes, wire.num_axes, wire.axes, ReferenceFields{});
      return;
    }
    const std::vector<contour_lcm::reference_point> axes(wire.axes.begin(), wire.axes.end() - 1);
    copy.List(core.axes, wire.num_axes, axes, ReferenceFields{});
    const contour_lcm::reference_point& mark = wire.axes.back();
    core.program_time_s = mark.position_m;
    if (mark.velocity_m_s >= 0.0) core.index = static_cast<std::uint64_t>(mark.velocity_m_s);
    core.law = Count(mark.acceleration_m_s2);
    core.line = Count(mark.extra_torque_Nm);
  }

 private:
  static std::uint32_t Count(double value) noexcept {
    return value >= 0.0 && value <= 4294967295.0 ? static_cast<std::uint32_t>(value) : 0;
  }
};

struct BusFields {
  void operator()(auto& copy, auto& core, auto& wire) const {
    copy(core.up, wire.up);
    copy(core.bus_off, wire.bus_off);
    copy(core.send_failures, wire.send_failures);
  }
};

struct IoFields {
  void operator()(auto& copy, auto& core, auto& wire) const {
    copy(core.configured, wire.configured);
    copy(core.fresh, wire.fresh);
    copy(core.emergency_stop_ok, wire.emergency_stop_ok);
    copy(core.enable_chain_ok, wire.enable_chain_ok);
    copy(core.screw_temperature_degC, wire.screw_temperature_degC);
  }
};

struct InputFields {
  void operator()(auto& copy, auto& core, auto& wire) const {
    copy(core.cycle, wire.cycle);
    copy(core.grid_time_ns, wire.grid_time_ns);
    copy.List(core.frames, wire.num_frames, wire.frames, FrameFields{});
    copy.List(core.buses, wire.num_buses, wire.buses, BusFields{});
    copy.List(core.path, wire.num_path_points, wire.path, PathPointFields{});
    copy(core.request.kind, wire.request_kind);
    copy(core.request.sequence, wire.request_sequence);
    copy(core.request.program_id, wire.request_program_id);
    IoFields{}(copy, core.io, wire.io);
  }
};

struct BringUpFields {
  void operator()(auto& copy, auto& core, auto& wire) const {
    copy(core.phase, wire.phase);
    copy(core.axis, wire.axis);
    copy(core.node_id, wire.node_id);
    copy(core.error, wire.error);
    copy(core.index, wire.index);
    copy(core.sub_index, wire.sub_index);
    copy(core.abort_code, wire.abort_code);
    copy(core.expected, wire.expected);
    copy(core.found, wire.found);
    copy(core.waited_us, wire.waited_us);
  }
};

struct StatusFields {
  void operator()(auto& copy, auto& core, auto& wire) const {
    copy(core.cycle, wire.cycle);
    copy(core.grid_time_ns, wire.grid_time_ns);
    copy(core.sync_number, wire.sync_number);
    copy(core.feedback_sync, wire.feedback_sync);
    copy(core.state, wire.state);
    copy(core.reason, wire.reason);
    copy(core.reason_axis, wire.reason_axis);
    copy(core.acknowledged, wire.acknowledged);
    copy(core.acknowledged_ok, wire.acknowledged_ok);
    copy(core.program_id, wire.program_id);
    copy(core.path_points_waiting, wire.path_points_waiting);
    copy(core.stale_cycles, wire.stale_cycles);
    IoFields{}(copy, core.io, wire.io);
    BringUpFields{}(copy, core.bring_up, wire.bring_up);
  }
};

struct ContourFields {
  void operator()(auto& copy, auto& core, auto& wire) const {
    copy(core.contour_error_m, wire.contour_error_m);
    copy(core.lag_error_m, wire.lag_error_m);
    copy(core.path_time_s, wire.path_time_s);
    copy(core.solver_iterations, wire.solver_iterations);
  }
};

struct TimingFields {
  void operator()(auto& copy, auto& core, auto& wire) const {
    copy(core.wakeup_late_ns, wire.wakeup_late_ns);
    copy(core.received_ns, wire.received_ns);
    copy(core.stepped_ns, wire.stepped_ns);
    copy(core.sent_ns, wire.sent_ns);
    copy(core.late, wire.late);
    copy(core.skipped_grid_points, wire.skipped_grid_points);
    copy(core.estimated_ns, wire.estimated_ns);
    copy(core.decided_ns, wire.decided_ns);
    copy(core.cause, wire.cause);
    copy(core.after_send_ns, wire.after_send_ns);
    copy(core.run_delay_ns, wire.run_delay_ns);
    copy(core.page_faults, wire.page_faults);
    copy(core.involuntary_switches, wire.involuntary_switches);
    copy(core.voluntary_switches, wire.voluntary_switches);
  }
};

struct AxisFields {
  void operator()(auto& copy, auto& core, auto& wire) const {
    copy(core.feedback.position_rad, wire.motor_angle_rad);
    copy(core.position_m, wire.position_m);
    copy(core.feedback.table_position_m, wire.table_position_m);
    copy(core.feedback.torque_Nm, wire.actual_torque_Nm);
    ReferenceFields{}(copy, core.reference, wire.reference);
    copy(core.following_error_m, wire.following_error_m);
    copy(core.torque_Nm, wire.torque_Nm);
    copy(core.wanted_torque_Nm, wire.wanted_torque_Nm);
    copy(core.feedforward_Nm, wire.feedforward_Nm);
    copy(core.target_position_rad, wire.target_position_rad);
    copy(core.feedback.statusword, wire.statusword);
    copy(core.feedback.drive_state, wire.drive_state);
    copy(core.goal, wire.goal);
    copy(core.feedback.fresh, wire.fresh);
    copy(core.feedback.valid, wire.valid);
    copy(core.feedback.has_scale, wire.has_scale);
    copy(core.feedback.age_cycles, wire.age_cycles);
    copy(core.limit, wire.limit);
    copy(core.emergency_code, wire.emergency_code);
  }
};

struct EstimateFields {
  void operator()(auto& copy, auto& core, auto& wire) const {
    copy(core.estimate.friction_N, wire.friction_N);
    copy(core.estimate.friction_std_N, wire.friction_std_N);
    copy(core.estimate.bristle_N, wire.bristle_N);
    copy(core.estimate.g_plus_N, wire.g_plus_N);
    copy(core.estimate.g_minus_N, wire.g_minus_N);
    copy(core.estimate.disturbance_N, wire.disturbance_N);
    copy(core.estimate.disturbance_std_N, wire.disturbance_std_N);
    copy(core.estimate.sigma0_N_m, wire.sigma0_N_m);
    copy(core.estimate.stiffness_N_m, wire.stiffness_N_m);
    copy(core.estimate.stiffness_std_N_m, wire.stiffness_std_N_m);
    copy(core.estimate.position_m, wire.position_m);
    copy(core.estimate.velocity_m_s, wire.velocity_m_s);
    copy(core.estimate.predicted_position_m, wire.predicted_position_m);
    copy(core.estimate.predicted_velocity_m_s, wire.predicted_velocity_m_s);
    copy(core.estimate.innovation_m, wire.innovation_m);
    copy(core.estimate.innovation_std_m, wire.innovation_std_m);
    copy(core.estimate.limit, wire.limit);
    copy(core.estimate.diverged, wire.diverged);
  }
};

struct EntryFields {
  void operator()(auto& copy, auto& core, auto& wire) const {
    InputFields{}(copy, core.input, wire.input);
    copy.List(core.output.frames, wire.num_sent, wire.sent, FrameFields{});
    copy(core.output.finished, wire.finished);
    copy(core.output.quiescent, wire.quiescent);
    copy(core.output.settling, wire.settling);
    StatusFields{}(copy, core.output.record, wire.status);
    ContourFields{}(copy, core.output.record, wire.contour);
    TimingFields{}(copy, core.timing, wire.timing);
    copy.List(core.output.record.axes, wire.num_axes, wire.axes, AxisFields{});
    copy.List(core.output.record.axes, wire.num_axes, wire.estimates, EstimateFields{});
  }
};

/// The messages that are also sent on their own say which cycle they belong to.
void Stamp(const CycleRecord& record, auto& message) {
  message.cycle = static_cast<std::int64_t>(record.cycle);
  message.grid_time_ns = record.grid_time_ns;
}

}  // namespace

void ToMessage(const CycleEntry& entry, contour_lcm::cycle_entry& message) {
  Writing writing;
  EntryFields{}(writing, entry, message);
  const CycleRecord& record = entry.output.record;
  Stamp(record, message.contour);
  Stamp(record, message.timing);
  for (std::size_t axis = 0; axis < record.axes.size(); ++axis) {
    Stamp(record, message.axes[axis]);
    Stamp(record, message.estimates[axis]);
    message.axes[axis].axis = static_cast<std::uint8_t>(axis);
    message.estimates[axis].axis = static_cast<std::uint8_t>(axis);
  }
}

bool FromMessage(const contour_lcm::cycle_entry& message, CycleEntry& entry) {
  Reading reading;
  EntryFields{}(reading, entry, message);
  return reading.fits && message.estimates.size() == message.axes.size();
}

contour_lcm::faults FaultsOf(const CycleRecord& record) {
  contour_lcm::faults m;
  Stamp(record, m);
  m.state = static_cast<std::uint8_t>(record.state);
  m.faulted = record.state == MachineState::kFaulted;
  m.reason = static_cast<std::int32_t>(record.reason);
  m.reason_name = Name(record.reason);
  m.reason_axis = record.reason_axis;
  m.stale_cycles = static_cast<std::int64_t>(record.stale_cycles);
  m.emergency_stop_ok = record.io.emergency_stop_ok;
  m.enable_chain_ok = record.io.enable_chain_ok;
  m.num_axes = static_cast<std::int32_t>(record.axes.size());
  for (std::size_t i = 0; i < record.axes.size(); ++i) {
    const AxisRecord& axis = record.axes[i];
    contour_lcm::axis_fault fault;
    fault.axis = static_cast<std::uint8_t>(i);
    fault.drive_state = static_cast<std::uint8_t>(axis.feedback.drive_state);
    fault.emergency_code = axis.emergency_code;
    fault.torque_limit = static_cast<std::int32_t>(axis.limit);
    fault.estimate_limit = static_cast<std::int32_t>(axis.estimate.limit);
    fault.estimate_diverged = axis.estimate.diverged;
    fault.feedback_age_cycles = axis.feedback.age_cycles;
    m.axes.push_back(fault);
  }
  return m;
}

}  // namespace contour
