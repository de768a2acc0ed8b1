#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>

#include "core/cycle_record.h"

namespace contour::test {

// Field by field, doubles by their bits. Written out by hand here, apart from the list of fields under test.

inline ::testing::AssertionResult Same(const char* what, double a, double b) {
  if (std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b))
    return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << what << ": " << a << " and " << b;
}

inline void ExpectSame(const StampedFrame& a, const StampedFrame& b) {
  EXPECT_EQ(a.frame, b.frame);
  EXPECT_EQ(a.bus, b.bus);
  EXPECT_EQ(a.stamp_ns, b.stamp_ns);
}

inline void ExpectSame(const ReferencePoint& a, const ReferencePoint& b) {
  EXPECT_TRUE(Same("position", a.position_m, b.position_m));
  EXPECT_TRUE(Same("velocity", a.velocity_m_s, b.velocity_m_s));
  EXPECT_TRUE(Same("acceleration", a.acceleration_m_s2, b.acceleration_m_s2));
  EXPECT_TRUE(Same("extra torque", a.extra_torque_Nm, b.extra_torque_Nm));
  EXPECT_TRUE(Same("spring", a.spring_N_m, b.spring_N_m));
}

inline void ExpectSame(const IoInput& a, const IoInput& b) {
  EXPECT_EQ(a.configured, b.configured);
  EXPECT_EQ(a.fresh, b.fresh);
  EXPECT_EQ(a.emergency_stop_ok, b.emergency_stop_ok);
  EXPECT_EQ(a.enable_chain_ok, b.enable_chain_ok);
  EXPECT_TRUE(Same("temperature", a.screw_temperature_degC, b.screw_temperature_degC));
}

inline void ExpectSame(const CycleInput& a, const CycleInput& b) {
  EXPECT_EQ(a.cycle, b.cycle);
  EXPECT_EQ(a.grid_time_ns, b.grid_time_ns);
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) ExpectSame(a.frames[i], b.frames[i]);
  ASSERT_EQ(a.buses.size(), b.buses.size());
  for (std::size_t i = 0; i < a.buses.size(); ++i) {
    EXPECT_EQ(a.buses[i].up, b.buses[i].up);
    EXPECT_EQ(a.buses[i].bus_off, b.buses[i].bus_off);
    EXPECT_EQ(a.buses[i].send_failures, b.buses[i].send_failures);
  }
  ASSERT_EQ(a.path.size(), b.path.size());
  for (std::size_t i = 0; i < a.path.size(); ++i) {
    EXPECT_EQ(a.path[i].program_id, b.path[i].program_id);
    EXPECT_EQ(a.path[i].last, b.path[i].last);
    EXPECT_EQ(a.path[i].index, b.path[i].index);
    EXPECT_EQ(a.path[i].law, b.path[i].law);
    EXPECT_EQ(a.path[i].line, b.path[i].line);
    EXPECT_TRUE(Same("program time", a.path[i].program_time_s, b.path[i].program_time_s));
    ASSERT_EQ(a.path[i].axes.size(), b.path[i].axes.size());
    for (std::size_t j = 0; j < a.path[i].axes.size(); ++j) ExpectSame(a.path[i].axes[j], b.path[i].axes[j]);
  }
  EXPECT_EQ(a.request.kind, b.request.kind);
  EXPECT_EQ(a.request.sequence, b.request.sequence);
  EXPECT_EQ(a.request.program_id, b.request.program_id);
  ExpectSame(a.io, b.io);
}

inline void ExpectSame(const AxisRecord& a, const AxisRecord& b) {
  EXPECT_TRUE(Same("angle", a.feedback.position_rad, b.feedback.position_rad));
  EXPECT_TRUE(Same("actual torque", a.feedback.torque_Nm, b.feedback.torque_Nm));
  EXPECT_TRUE(Same("scale", a.feedback.table_position_m, b.feedback.table_position_m));
  EXPECT_EQ(a.feedback.statusword, b.feedback.statusword);
  EXPECT_EQ(a.feedback.drive_state, b.feedback.drive_state);
  EXPECT_EQ(a.feedback.fresh, b.feedback.fresh);
  EXPECT_EQ(a.feedback.valid, b.feedback.valid);
  EXPECT_EQ(a.feedback.has_scale, b.feedback.has_scale);
  EXPECT_EQ(a.feedback.age_cycles, b.feedback.age_cycles);
  ExpectSame(a.reference, b.reference);
  EXPECT_TRUE(Same("position", a.position_m, b.position_m));
  EXPECT_TRUE(Same("following error", a.following_error_m, b.following_error_m));
  EXPECT_TRUE(Same("feed-forward", a.feedforward_Nm, b.feedforward_Nm));
  EXPECT_TRUE(Same("wanted", a.wanted_torque_Nm, b.wanted_torque_Nm));
  EXPECT_TRUE(Same("torque", a.torque_Nm, b.torque_Nm));
  EXPECT_TRUE(Same("target", a.target_position_rad, b.target_position_rad));
  EXPECT_EQ(a.goal, b.goal);
  EXPECT_EQ(a.limit, b.limit);
  EXPECT_EQ(a.emergency_code, b.emergency_code);
  const AxisEstimate &x = a.estimate, &y = b.estimate;
  EXPECT_TRUE(Same("estimated position", x.position_m, y.position_m));
  EXPECT_TRUE(Same("estimated velocity", x.velocity_m_s, y.velocity_m_s));
  EXPECT_TRUE(Same("predicted position", x.predicted_position_m, y.predicted_position_m));
  EXPECT_TRUE(Same("predicted velocity", x.predicted_velocity_m_s, y.predicted_velocity_m_s));
  EXPECT_TRUE(Same("friction", x.friction_N, y.friction_N));
  EXPECT_TRUE(Same("friction std", x.friction_std_N, y.friction_std_N));
  EXPECT_TRUE(Same("bristle", x.bristle_N, y.bristle_N));
  EXPECT_TRUE(Same("g+", x.g_plus_N, y.g_plus_N));
  EXPECT_TRUE(Same("g-", x.g_minus_N, y.g_minus_N));
  EXPECT_TRUE(Same("disturbance", x.disturbance_N, y.disturbance_N));
  EXPECT_TRUE(Same("disturbance std", x.disturbance_std_N, y.disturbance_std_N));
  EXPECT_TRUE(Same("sigma0", x.sigma0_N_m, y.sigma0_N_m));
  EXPECT_TRUE(Same("stiffness", x.stiffness_N_m, y.stiffness_N_m));
  EXPECT_TRUE(Same("stiffness std", x.stiffness_std_N_m, y.stiffness_std_N_m));
  EXPECT_TRUE(Same("innovation", x.innovation_m, y.innovation_m));
  EXPECT_TRUE(Same("innovation std", x.innovation_std_m, y.innovation_std_m));
  EXPECT_EQ(x.limit, y.limit);
  EXPECT_EQ(x.diverged, y.diverged);
}

inline void ExpectSame(const BringUpStatus& a, const BringUpStatus& b) {
  EXPECT_EQ(a.phase, b.phase);
  EXPECT_EQ(a.axis, b.axis);
  EXPECT_EQ(a.node_id, b.node_id);
  EXPECT_EQ(a.error, b.error);
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.sub_index, b.sub_index);
  EXPECT_EQ(a.abort_code, b.abort_code);
  EXPECT_EQ(a.expected, b.expected);
  EXPECT_EQ(a.found, b.found);
  EXPECT_EQ(a.waited_us, b.waited_us);
}

inline void ExpectSame(const CycleRecord& a, const CycleRecord& b) {
  EXPECT_EQ(a.cycle, b.cycle);
  EXPECT_EQ(a.grid_time_ns, b.grid_time_ns);
  EXPECT_EQ(a.sync_number, b.sync_number);
  EXPECT_EQ(a.feedback_sync, b.feedback_sync);
  EXPECT_EQ(a.state, b.state);
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.reason_axis, b.reason_axis);
  EXPECT_EQ(a.acknowledged, b.acknowledged);
  EXPECT_EQ(a.acknowledged_ok, b.acknowledged_ok);
  EXPECT_EQ(a.program_id, b.program_id);
  EXPECT_TRUE(Same("path time", a.path_time_s, b.path_time_s));
  EXPECT_TRUE(Same("contour error", a.contour_error_m, b.contour_error_m));
  EXPECT_TRUE(Same("lag error", a.lag_error_m, b.lag_error_m));
  EXPECT_EQ(a.path_points_waiting, b.path_points_waiting);
  EXPECT_EQ(a.solver_iterations, b.solver_iterations);
  EXPECT_EQ(a.stale_cycles, b.stale_cycles);
  ExpectSame(a.io, b.io);
  ExpectSame(a.bring_up, b.bring_up);
  ASSERT_EQ(a.axes.size(), b.axes.size());
  for (std::size_t i = 0; i < a.axes.size(); ++i) ExpectSame(a.axes[i], b.axes[i]);
}

inline void ExpectSame(const CycleTiming& a, const CycleTiming& b) {
  EXPECT_EQ(a.wakeup_late_ns, b.wakeup_late_ns);
  EXPECT_EQ(a.received_ns, b.received_ns);
  EXPECT_EQ(a.stepped_ns, b.stepped_ns);
  EXPECT_EQ(a.sent_ns, b.sent_ns);
  EXPECT_EQ(a.late, b.late);
  EXPECT_EQ(a.skipped_grid_points, b.skipped_grid_points);
  EXPECT_EQ(a.estimated_ns, b.estimated_ns);
  EXPECT_EQ(a.decided_ns, b.decided_ns);
  EXPECT_EQ(a.cause, b.cause);
  EXPECT_EQ(a.after_send_ns, b.after_send_ns);
  EXPECT_EQ(a.run_delay_ns, b.run_delay_ns);
  EXPECT_EQ(a.page_faults, b.page_faults);
  EXPECT_EQ(a.involuntary_switches, b.involuntary_switches);
  EXPECT_EQ(a.voluntary_switches, b.voluntary_switches);
}

inline void ExpectSame(const CycleEntry& a, const CycleEntry& b) {
  ExpectSame(a.input, b.input);
  ASSERT_EQ(a.output.frames.size(), b.output.frames.size());
  for (std::size_t i = 0; i < a.output.frames.size(); ++i) ExpectSame(a.output.frames[i], b.output.frames[i]);
  EXPECT_EQ(a.output.finished, b.output.finished);
  EXPECT_EQ(a.output.quiescent, b.output.quiescent);
  EXPECT_EQ(a.output.settling, b.output.settling);
  ExpectSame(a.output.record, b.output.record);
  ExpectSame(a.timing, b.timing);
}

}  // namespace contour::test
