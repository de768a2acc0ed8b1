#include "tools/replay/output_quantities.h"

#include <array>
#include <bit>
#include <charconv>
#include <cstdio>
#include <string_view>

namespace contour {
namespace {

struct MachineQuantity {
  std::string_view name;
  OutputValue (*value)(const CycleOutput&);
};

template <class Integer>
OutputValue Whole(Integer value) {
  return static_cast<std::int64_t>(value);
}
template <class Enum>
OutputValue Named(Enum value) {
  return std::string(Name(value));
}

constexpr MachineQuantity kMachine[] = {
    {"sync_number", [](const CycleOutput& o) { return Whole(o.record.sync_number); }},
    {"feedback_sync", [](const CycleOutput& o) { return Whole(o.record.feedback_sync); }},
    {"state", [](const CycleOutput& o) { return Named(o.record.state); }},
    {"reason", [](const CycleOutput& o) { return Named(o.record.reason); }},
    {"reason_axis", [](const CycleOutput& o) { return Whole(o.record.reason_axis); }},
    {"acknowledged", [](const CycleOutput& o) { return Whole(o.record.acknowledged); }},
    {"acknowledged_ok", [](const CycleOutput& o) { return Whole(o.record.acknowledged_ok); }},
    {"program_id", [](const CycleOutput& o) { return Whole(o.record.program_id); }},
    {"path_time_s", [](const CycleOutput& o) -> OutputValue { return o.record.path_time_s; }},
    {"contour_error_m", [](const CycleOutput& o) -> OutputValue { return o.record.contour_error_m; }},
    {"lag_error_m", [](const CycleOutput& o) -> OutputValue { return o.record.lag_error_m; }},
    {"path_points_waiting", [](const CycleOutput& o) { return Whole(o.record.path_points_waiting); }},
    {"solver_iterations", [](const CycleOutput& o) { return Whole(o.record.solver_iterations); }},
    {"stale_cycles", [](const CycleOutput& o) { return Whole(o.record.stale_cycles); }},
    {"bring_up_phase", [](const CycleOutput& o) { return Whole(o.record.bring_up.phase); }},
    {"bring_up_error", [](const CycleOutput& o) { return Whole(o.record.bring_up.error); }},
    {"finished", [](const CycleOutput& o) { return Whole(o.finished); }},
    {"quiescent", [](const CycleOutput& o) { return Whole(o.quiescent); }},
    {"settling", [](const CycleOutput& o) { return Whole(o.settling); }},
};

struct AxisQuantity {
  std::string_view name;
  OutputValue (*value)(const AxisRecord&);
};

constexpr AxisQuantity kAxis[] = {
    {"motor_angle_rad", [](const AxisRecord& a) -> OutputValue { return a.feedback.position_rad; }},
    {"actual_torque_Nm", [](const AxisRecord& a) -> OutputValue { return a.feedback.torque_Nm; }},
    {"table_position_m", [](const AxisRecord& a) -> OutputValue { return a.feedback.table_position_m; }},
    {"statusword", [](const AxisRecord& a) { return Whole(a.feedback.statusword); }},
    {"drive_state", [](const AxisRecord& a) { return Named(a.feedback.drive_state); }},
    {"feedback_fresh", [](const AxisRecord& a) { return Whole(a.feedback.fresh); }},
    {"feedback_age_cycles", [](const AxisRecord& a) { return Whole(a.feedback.age_cycles); }},
    {"position_m", [](const AxisRecord& a) -> OutputValue { return a.position_m; }},
    {"reference_position_m", [](const AxisRecord& a) -> OutputValue { return a.reference.position_m; }},
    {"reference_velocity_m_s", [](const AxisRecord& a) -> OutputValue { return a.reference.velocity_m_s; }},
    {"reference_acceleration_m_s2",
     [](const AxisRecord& a) -> OutputValue { return a.reference.acceleration_m_s2; }},
    {"extra_torque_Nm", [](const AxisRecord& a) -> OutputValue { return a.reference.extra_torque_Nm; }},
    {"spring_N_m", [](const AxisRecord& a) -> OutputValue { return a.reference.spring_N_m; }},
    {"following_error_m", [](const AxisRecord& a) -> OutputValue { return a.following_error_m; }},
    {"estimated_position_m", [](const AxisRecord& a) -> OutputValue { return a.estimate.position_m; }},
    {"estimated_velocity_m_s", [](const AxisRecord& a) -> OutputValue { return a.estimate.velocity_m_s; }},
    {"predicted_position_m",
     [](const AxisRecord& a) -> OutputValue { return a.estimate.predicted_position_m; }},
    {"predicted_velocity_m_s",
     [](const AxisRecord& a) -> OutputValue { return a.estimate.predicted_velocity_m_s; }},
    {"friction_N", [](const AxisRecord& a) -> OutputValue { return a.estimate.friction_N; }},
    {"friction_std_N", [](const AxisRecord& a) -> OutputValue { return a.estimate.friction_std_N; }},
    {"bristle_N", [](const AxisRecord& a) -> OutputValue { return a.estimate.bristle_N; }},
    {"g_plus_N", [](const AxisRecord& a) -> OutputValue { return a.estimate.g_plus_N; }},
    {"g_minus_N", [](const AxisRecord& a) -> OutputValue { return a.estimate.g_minus_N; }},
    {"disturbance_N", [](const AxisRecord& a) -> OutputValue { return a.estimate.disturbance_N; }},
    {"disturbance_std_N", [](const AxisRecord& a) -> OutputValue { return a.estimate.disturbance_std_N; }},
    {"sigma0_N_m", [](const AxisRecord& a) -> OutputValue { return a.estimate.sigma0_N_m; }},
    {"stiffness_N_m", [](const AxisRecord& a) -> OutputValue { return a.estimate.stiffness_N_m; }},
    {"stiffness_std_N_m", [](const AxisRecord& a) -> OutputValue { return a.estimate.stiffness_std_N_m; }},
    {"innovation_m", [](const AxisRecord& a) -> OutputValue { return a.estimate.innovation_m; }},
    {"innovation_std_m", [](const AxisRecord& a) -> OutputValue { return a.estimate.innovation_std_m; }},
    {"estimate_limit", [](const AxisRecord& a) { return Named(a.estimate.limit); }},
    {"estimate_diverged", [](const AxisRecord& a) { return Whole(a.estimate.diverged); }},
    {"feedforward_torque_Nm", [](const AxisRecord& a) -> OutputValue { return a.feedforward_Nm; }},
    {"wanted_torque_Nm", [](const AxisRecord& a) -> OutputValue { return a.wanted_torque_Nm; }},
    {"torque_Nm", [](const AxisRecord& a) -> OutputValue { return a.torque_Nm; }},
    {"target_motor_angle_rad", [](const AxisRecord& a) -> OutputValue { return a.target_position_rad; }},
    {"goal", [](const AxisRecord& a) { return Whole(a.goal); }},
    {"limit", [](const AxisRecord& a) { return Named(a.limit); }},
    {"emergency_code", [](const AxisRecord& a) { return Whole(a.emergency_code); }},
};

/// As candump writes frames, one after the other, with the bus before an identifier.
std::string FramesText(const CycleOutput& output) {
  std::string text;
  std::array<char, 32> part;
  for (const StampedFrame& f : output.frames) {
    std::snprintf(part.data(), part.size(), "%s%u:%03X#", text.empty() ? "" : " ", unsigned{f.bus},
                  unsigned{f.frame.id});
    text += part.data();
    for (std::size_t i = 0; i < f.frame.length && i < f.frame.data.size(); ++i) {
      std::snprintf(part.data(), part.size(), "%02X", unsigned{f.frame.data[i]});
      text += part.data();
    }
  }
  return text;
}

}  // namespace

OutputQuantities::OutputQuantities(std::span<const std::string> axis_names) : axes_(axis_names.size()) {
  for (const MachineQuantity& q : kMachine) names_.emplace_back(q.name);
  for (const std::string& axis : axis_names)
    for (const AxisQuantity& q : kAxis) names_.push_back(axis + "_" + std::string(q.name));
  names_.emplace_back("frames");
}

void OutputQuantities::Values(const CycleOutput& output, std::vector<OutputValue>& values) const {
  values.clear();
  for (const MachineQuantity& q : kMachine) values.push_back(q.value(output));
  for (std::size_t i = 0; i < axes_; ++i) {
    const AxisRecord& axis = i < output.record.axes.size() ? output.record.axes[i] : AxisRecord{};
    for (const AxisQuantity& q : kAxis) values.push_back(q.value(axis));
  }
  values.emplace_back(FramesText(output));
}

bool Identical(const OutputValue& a, const OutputValue& b) {
  if (const double* x = std::get_if<double>(&a))
    if (const double* y = std::get_if<double>(&b))
      return std::bit_cast<std::uint64_t>(*x) == std::bit_cast<std::uint64_t>(*y);
  return a == b;
}

std::string Text(const OutputValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return text->empty() ? "nothing" : *text;
  std::array<char, 32> text;
  const auto print = [&](auto number) {
    return std::string(text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr);
  };
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return print(*whole);
  return print(std::get<double>(value));
}

}  // namespace contour
