#include "daemon/control_socket/machine_status.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "drivers/cia301/emergency_table.h"

namespace contour {
namespace {

using nlohmann::json;

json Number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json Summary(const TimingSummary& s) {
  return {{"p50_us", s.p50_us}, {"p99_us", s.p99_us}, {"p999_us", s.p999_us}, {"max_us", s.max_us}};
}

json Axis(const std::string& name, const AxisRecord& a) {
  return {
      {"name", name},
      {"drive_state", Name(a.feedback.drive_state)},
      {"statusword", a.feedback.statusword},
      {"emergency_code", a.emergency_code},
      {"referenced", IsReferenced(a.reference_state)},
      {"reference", Name(a.reference_state)},
      {"feedback_fresh", a.feedback.fresh},
      {"feedback_age_cycles", a.feedback.age_cycles},
      {"motor_angle_rad", Number(a.feedback.position_rad)},
      {"position_m", Number(a.position_m)},
      {"table_position_m", a.feedback.has_scale ? Number(a.feedback.table_position_m) : json(nullptr)},
      {"reference_position_m", Number(a.reference.position_m)},
      {"following_error_m", Number(a.following_error_m)},
      {"velocity_m_s", Number(a.estimate.velocity_m_s)},
      {"torque_Nm", Number(a.torque_Nm)},
      {"actual_torque_Nm", Number(a.feedback.torque_Nm)},
      {"friction_N", Number(a.estimate.friction_N)},
      {"friction_std_N", Number(a.estimate.friction_std_N)},
      {"friction_level_plus_N", Number(a.estimate.g_plus_N)},
      {"friction_level_minus_N", Number(a.estimate.g_minus_N)},
      {"sigma0_N_m", Number(a.estimate.sigma0_N_m)},
      {"disturbance_N", Number(a.estimate.disturbance_N)},
      {"disturbance_std_N", Number(a.estimate.disturbance_std_N)},
      {"stiffness_N_m", Number(a.estimate.stiffness_N_m)},
      {"stiffness_std_N_m", Number(a.estimate.stiffness_std_N_m)},
      {"limit", Name(a.limit)},
      {"estimate_limit", Name(a.estimate.limit)},
      {"estimate_diverged", a.estimate.diverged},
  };
}

/// Where programs count from, axis by axis; null before it is set.
json Zero(const MachineStatus& s) {
  if (!s.zero_m) return nullptr;
  json zero = json::object();
  for (std::size_t i = 0; i < s.zero_m->size() && i < s.axis_names.size(); ++i)
    zero[s.axis_names[i]] = (*s.zero_m)[i] * 1e3;
  return zero;
}

json Facts(const AxisFacts& f) {
  return {{"position_min_m", f.limits.position_min_m},
          {"position_max_m", f.limits.position_max_m},
          {"velocity_m_s", f.limits.velocity_m_s},
          {"acceleration_m_s2", f.limits.acceleration_m_s2},
          {"jerk_m_s3", f.limits.jerk_m_s3},
          {"encoder_count_m", f.encoder_count_m},
          {"path_following_m", f.limits.path_following_m}};
}

json Buses(const MachineStatus& s) {
  json buses = json::array();
  for (std::size_t i = 0; i < s.buses.size(); ++i) {
    const BusStatus& b = s.buses[i];
    const auto foreign = i < s.foreign.size() ? s.foreign[i] : ForeignTraffic::OnBus{};
    buses.push_back({{"name", b.name},
                     {"interface", b.interface},
                     {"up", b.state.up},
                     {"bus_off", b.state.bus_off},
                     {"controller_errors", Name(b.state.errors)},
                     {"transmit_errors", b.state.transmit_errors},
                     {"receive_errors", b.state.receive_errors},
                     {"bus_offs", b.state.bus_offs},
                     {"frames_received", b.state.frames_received},
                     {"frames_sent", b.state.frames_sent},
                     {"send_failures", b.state.send_failures},
                     {"error_frames", b.state.error_frames},
                     {"receive_overflows", b.state.receive_overflows},
                     {"frames_dropped", b.state.frames_dropped},
                     {"foreign_sdo_requests", foreign.sdo_requests},
                     {"other_nodes", foreign.nodes}});
  }
  return buses;
}

json Io(const MachineStatus& s) {
  if (!s.io.configured) return nullptr;
  return {{"connected", s.io.connected},
          {"fresh", s.record.io.fresh},
          {"emergency_stop_ok", s.record.io.emergency_stop_ok},
          {"enable_chain_ok", s.record.io.enable_chain_ok},
          {"screw_temperature_degC", Number(s.record.io.screw_temperature_degC)},
          {"polls", s.io.polls},
          {"failures", s.io.failures},
          {"connections", s.io.connections},
          {"lubrication_pulses", s.io.lubrication_pulses},
          {"last_error", s.io.last_error}};
}

json Late(const MachineStatus& s) {
  if (!s.late_cycles) return nullptr;
  json causes = json::object();
  for (std::size_t c = 1; c < kLateCauses; ++c)
    causes[std::string(Name(static_cast<LateCause>(c)))] = s.health.causes[c];
  const bool any = s.health.late_cycles != 0;
  return {{"cycles", s.health.late_cycles},
          {"causes", causes},
          {"last", any ? json{{"cycle", s.health.last_late_cycle},
                              {"cause", Name(s.health.last_cause)},
                              {"sent_us", s.health.last_late_us}}
                       : json(nullptr)}};
}

json Feedback(const MachineStatus& s, std::size_t i) {
  const auto axis = i < s.health.axes.size() ? s.health.axes[i] : CycleHealth::AxisSummary{};
  return {{"stale_cycles", axis.stale_cycles}, {"response", Summary(axis.response)}};
}

json Errors(const DriveErrors& d) {
  json received = json::array();
  for (const ReceivedEmergency& e : d.received)
    received.push_back({{"cycle", e.cycle},
                        {"grid_time_ns", e.grid_time_ns},
                        {"code", e.emergency.error_code},
                        {"register", e.emergency.error_register},
                        {"maker", e.maker},
                        {"text", EmergencyText(e.emergency.error_code)},
                        {"reaction", Name(ReactionTo(e.emergency))}});
  json stored = json::array();
  for (const std::uint32_t error : d.stored)
    stored.push_back({{"code", error & 0xFFFF},
                      {"maker", error >> 16},
                      {"text", EmergencyText(static_cast<std::uint16_t>(error & 0xFFFF))}});
  return {{"received", received},       {"received_count", d.received_count},
          {"stored", stored},           {"stored_cycle", d.stored_cycle},
          {"mode_reads", d.mode_reads}, {"mode_answers", d.mode_answers}};
}

json Axes(const MachineStatus& s) {
  json axes = json::array();
  for (std::size_t i = 0; i < s.axis_names.size(); ++i) {
    axes.push_back(Axis(s.axis_names[i], i < s.record.axes.size() ? s.record.axes[i] : AxisRecord{}));
    axes.back()["feedback"] = Feedback(s, i);
    axes.back()["errors"] = Errors(i < s.drive_errors.size() ? s.drive_errors[i] : DriveErrors{});
    if (i < s.axis_facts.size()) axes.back()["facts"] = Facts(s.axis_facts[i]);
  }
  return axes;
}

json Flight(const FlightRecordStats& f) {
  if (!f.enabled) return nullptr;
  return {{"directory", f.directory},     {"file", f.file.empty() ? json(nullptr) : json(f.file)},
          {"first_cycle", f.first_cycle}, {"last_cycle", f.last_cycle},
          {"reason", f.reason},           {"written", f.written},
          {"last_error", f.last_error}};
}

json Log(const LogStats& log) {
  if (log.file.empty()) return nullptr;
  return {{"file", log.file},
          {"cycles", log.cycles},
          {"lost_cycles", log.lost_cycles},
          {"lost_notes", log.lost_notes},
          {"waiting_cycles", log.waiting_cycles},
          {"bytes", log.bytes},
          {"last_error", log.last_error}};
}

json Lcm(const PublisherStats& p) {
  if (!p.enabled) return nullptr;
  return {{"messages", p.messages}, {"failures", p.failures}, {"last_error", p.last_error}};
}

/// Of the program that runs, at the feed that is wanted; null in a pause, and when none runs.
json TimeLeft_s(const MachineStatus& s) {
  const bool goes = s.record.state == MachineState::kRunning && !s.pace.pause_wanted;
  if (!goes || s.pace.feed_percent <= 0.0 || s.program_duration_s <= 0.0) return nullptr;
  const double feed = 0.01 * (s.pace.feed_fixed ? std::min(100.0, s.pace.feed_percent) : s.pace.feed_percent);
  const double left_s = std::max(0.0, s.program_duration_s - s.record.path_time_s);
  // Above the programmed feed the axes may bind.
  return feed > 1.0 ? left_s * std::clamp(s.program_time_share, 1.0 / feed, 1.0) : left_s / feed;
}

json Halt(const std::optional<HaltStatus>& halt) {
  if (!halt) return nullptr;
  return {{"line", halt->line},
          {"word", halt->word},
          {"for_operator", halt->for_operator},
          {"number", halt->number}};
}

json ProgramNow(const MachineStatus& s) {
  const CycleRecord& r = s.record;
  return {{"id", r.program_id},
          {"name", s.program_name},
          {"time_s", Number(r.path_time_s)},
          {"duration_s", Number(s.program_duration_s)},
          {"duration_estimated", s.program_duration_estimated},
          {"left_s", TimeLeft_s(s)},
          {"ran_s", s.program_ran_s},
          {"contour_error_peak_m", Number(s.contour_error_peak_m)},
          {"contour_error_rms_m", Number(s.contour_error_rms_m)},
          {"line", r.program_line != 0 ? json(r.program_line) : json(nullptr)},
          {"feed_percent", s.pace.feed_percent},
          {"feed_fixed", s.pace.feed_fixed},
          {"pace", Number(r.pace)},
          {"pausing", s.pace.pause_wanted},
          {"paused", s.pace.paused},
          {"halt", Halt(s.pace.halt)}};
}

}  // namespace

nlohmann::json ToJson(const MachineStatus& s) {
  const CycleRecord& r = s.record;
  const json late = s.late_cycles ? json(*s.late_cycles) : json(nullptr);
  return {
      {"machine", s.machine},
      {"version", s.version},
      {"controller", s.controller},
      {"clock", s.clock},
      {"cycle_us", s.cycle_us},
      {"emulator_seed", s.emulator_seed ? nlohmann::json(*s.emulator_seed) : nlohmann::json()},
      {"warnings", s.warnings},
      {"state", Name(r.state)},
      {"reason", Name(r.reason)},
      {"reason_is_fault", IsFault(r.reason)},
      {"reason_text", s.reason_text},
      {"bring_up", s.bring_up},
      {"cycle", r.cycle},
      {"acknowledged", r.acknowledged},
      {"program", ProgramNow(s)},
      {"zero_mm", Zero(s)},
      {"program_defaults",
       {{"optional_stop", s.program_defaults.optional_stop},
        {"block_delete", s.program_defaults.block_delete},
        {"tool_table", s.program_defaults.tool_table},
        {"outputs", s.program_defaults.outputs}}},
      {"contour_error_m", Number(r.contour_error_m)},
      {"lag_error_m", Number(r.lag_error_m)},
      {"axes", Axes(s)},
      {"cycles", s.cycles},
      {"late_cycles", late},
      {"stale_cycles", r.stale_cycles},
      {"skipped_grid_points", s.skipped_grid_points},
      {"dropped_telemetry", s.dropped_entries},
      {"timing",
       {{"wakeup_late", Summary(s.health.wakeup_late)},
        {"receiving", Summary(s.health.receiving)},
        {"estimating", Summary(s.health.estimating)},
        {"deciding", Summary(s.health.deciding)},
        {"computing", Summary(s.health.computing)},
        {"sending", Summary(s.health.sending)},
        {"sent", Summary(s.health.sent)}}},
      {"late", Late(s)},
      {"page_faults", s.health.page_faults},
      {"involuntary_switches", s.health.involuntary_switches},
      {"buses", Buses(s)},
      {"io", Io(s)},
      {"lcm", Lcm(s.publisher)},
      {"log", Log(s.log)},
      {"flight_record", Flight(s.flight)},
  };
}

}  // namespace contour
