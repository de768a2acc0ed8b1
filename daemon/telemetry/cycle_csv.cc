#include "daemon/telemetry/cycle_csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace contour {
namespace {

/// Writes the fields of a line one after the other, with the commas between them.
class Line {
 public:
  explicit Line(std::string& out) : out_(out) {}

  void Field(std::string_view text) {
    if (!first_) out_ += ',';
    first_ = false;
    out_ += text;
  }
  void Field(bool value) { Field(value ? std::string_view{"1"} : std::string_view{"0"}); }
  template <class Number>
  requires(std::integral<Number> || std::floating_point<Number>) void Field(Number value) {
    std::array<char, 32> text;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
    Field(std::string_view(text.data(), static_cast<std::size_t>(end.ptr - text.data())));
  }
  void Empty() { Field(std::string_view{}); }

 private:
  std::string& out_;
  bool first_ = true;
};

struct Row {
  const CycleRecord& record;
  const CycleTiming& timing;
  double time_s;
};

constexpr double Us(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

struct CycleColumn {
  std::string_view name;
  void (*write)(const Row&, Line&);
};

constexpr CycleColumn kCycleColumns[] = {
    {"cycle", [](const Row& r, Line& l) { l.Field(r.record.cycle); }},
    {"time_s", [](const Row& r, Line& l) { l.Field(r.time_s); }},
    {"sync_number", [](const Row& r, Line& l) { l.Field(r.record.sync_number); }},
    {"feedback_sync", [](const Row& r, Line& l) { l.Field(r.record.feedback_sync); }},
    {"state", [](const Row& r, Line& l) { l.Field(Name(r.record.state)); }},
    {"reason", [](const Row& r, Line& l) { l.Field(Name(r.record.reason)); }},
    {"reason_axis",
     [](const Row& r, Line& l) {
       if (r.record.reason_axis == 0xFF) return l.Empty();
       l.Field(r.record.reason_axis);
     }},
    {"program_id", [](const Row& r, Line& l) { l.Field(r.record.program_id); }},
    {"path_time_s", [](const Row& r, Line& l) { l.Field(r.record.path_time_s); }},
    {"contour_error_m", [](const Row& r, Line& l) { l.Field(r.record.contour_error_m); }},
    {"lag_error_m", [](const Row& r, Line& l) { l.Field(r.record.lag_error_m); }},
    {"path_points_waiting", [](const Row& r, Line& l) { l.Field(r.record.path_points_waiting); }},
    {"solver_iterations", [](const Row& r, Line& l) { l.Field(r.record.solver_iterations); }},
    {"stale_cycles", [](const Row& r, Line& l) { l.Field(r.record.stale_cycles); }},
    {"io_fresh", [](const Row& r, Line& l) { l.Field(r.record.io.fresh); }},
    {"emergency_stop_ok", [](const Row& r, Line& l) { l.Field(r.record.io.emergency_stop_ok); }},
    {"enable_chain_ok", [](const Row& r, Line& l) { l.Field(r.record.io.enable_chain_ok); }},
    {"temperature_degC",
     [](const Row& r, Line& l) {
       const bool known = r.record.io.configured && !std::isnan(r.record.io.screw_temperature_degC);
       if (!known) return l.Empty();
       l.Field(r.record.io.screw_temperature_degC);
     }},
    {"wakeup_late_us", [](const Row& r, Line& l) { l.Field(Us(r.timing.wakeup_late_ns)); }},
    {"received_us", [](const Row& r, Line& l) { l.Field(Us(r.timing.received_ns)); }},
    {"stepped_us", [](const Row& r, Line& l) { l.Field(Us(r.timing.stepped_ns)); }},
    {"sent_us", [](const Row& r, Line& l) { l.Field(Us(r.timing.sent_ns)); }},
    {"late", [](const Row& r, Line& l) { l.Field(r.timing.late); }},
    {"skipped_grid_points", [](const Row& r, Line& l) { l.Field(r.timing.skipped_grid_points); }},
    {"late_cause", [](const Row& r, Line& l) { l.Field(Name(r.timing.cause)); }},
    {"estimated_us", [](const Row& r, Line& l) { l.Field(Us(r.timing.estimated_ns)); }},
    {"decided_us", [](const Row& r, Line& l) { l.Field(Us(r.timing.decided_ns)); }},
    {"page_faults", [](const Row& r, Line& l) { l.Field(r.timing.page_faults); }},
    {"involuntary_switches", [](const Row& r, Line& l) { l.Field(r.timing.involuntary_switches); }},
};

struct AxisColumn {
  std::string_view name;  ///< after "<axis>_"
  void (*write)(const AxisRecord&, Line&);
};

constexpr AxisColumn kAxisColumns[] = {
    {"motor_angle_rad", [](const AxisRecord& a, Line& l) { l.Field(a.feedback.position_rad); }},
    {"torque_Nm", [](const AxisRecord& a, Line& l) { l.Field(a.torque_Nm); }},
    {"position_m", [](const AxisRecord& a, Line& l) { l.Field(a.position_m); }},
    {"table_position_m",
     [](const AxisRecord& a, Line& l) {
       if (!a.feedback.has_scale) return l.Empty();
       l.Field(a.feedback.table_position_m);
     }},
    {"reference_position_m", [](const AxisRecord& a, Line& l) { l.Field(a.reference.position_m); }},
    {"reference_velocity_m_s", [](const AxisRecord& a, Line& l) { l.Field(a.reference.velocity_m_s); }},
    {"reference_acceleration_m_s2",
     [](const AxisRecord& a, Line& l) { l.Field(a.reference.acceleration_m_s2); }},
    {"following_error_m", [](const AxisRecord& a, Line& l) { l.Field(a.following_error_m); }},
    {"estimated_position_m", [](const AxisRecord& a, Line& l) { l.Field(a.estimate.position_m); }},
    {"estimated_velocity_m_s", [](const AxisRecord& a, Line& l) { l.Field(a.estimate.velocity_m_s); }},
    {"friction_N", [](const AxisRecord& a, Line& l) { l.Field(a.estimate.friction_N); }},
    {"friction_std_N", [](const AxisRecord& a, Line& l) { l.Field(a.estimate.friction_std_N); }},
    {"bristle_N", [](const AxisRecord& a, Line& l) { l.Field(a.estimate.bristle_N); }},
    {"g_plus_N", [](const AxisRecord& a, Line& l) { l.Field(a.estimate.g_plus_N); }},
    {"g_minus_N", [](const AxisRecord& a, Line& l) { l.Field(a.estimate.g_minus_N); }},
    {"disturbance_N", [](const AxisRecord& a, Line& l) { l.Field(a.estimate.disturbance_N); }},
    {"disturbance_std_N", [](const AxisRecord& a, Line& l) { l.Field(a.estimate.disturbance_std_N); }},
    {"sigma0_N_m", [](const AxisRecord& a, Line& l) { l.Field(a.estimate.sigma0_N_m); }},
    {"stiffness_N_m", [](const AxisRecord& a, Line& l) { l.Field(a.estimate.stiffness_N_m); }},
    {"stiffness_std_N_m", [](const AxisRecord& a, Line& l) { l.Field(a.estimate.stiffness_std_N_m); }},
    {"innovation_m", [](const AxisRecord& a, Line& l) { l.Field(a.estimate.innovation_m); }},
    {"innovation_std_m", [](const AxisRecord& a, Line& l) { l.Field(a.estimate.innovation_std_m); }},
    {"feedforward_torque_Nm", [](const AxisRecord& a, Line& l) { l.Field(a.feedforward_Nm); }},
    {"wanted_torque_Nm", [](const AxisRecord& a, Line& l) { l.Field(a.wanted_torque_Nm); }},
    {"actual_torque_Nm", [](const AxisRecord& a, Line& l) { l.Field(a.feedback.torque_Nm); }},
    {"target_motor_angle_rad", [](const AxisRecord& a, Line& l) { l.Field(a.target_position_rad); }},
    {"drive_state", [](const AxisRecord& a, Line& l) { l.Field(Name(a.feedback.drive_state)); }},
    {"statusword", [](const AxisRecord& a, Line& l) { l.Field(a.feedback.statusword); }},
    {"limit", [](const AxisRecord& a, Line& l) { l.Field(Name(a.limit)); }},
    {"estimate_limit", [](const AxisRecord& a, Line& l) { l.Field(Name(a.estimate.limit)); }},
    {"estimate_diverged", [](const AxisRecord& a, Line& l) { l.Field(a.estimate.diverged); }},
    {"emergency_code", [](const AxisRecord& a, Line& l) { l.Field(a.emergency_code); }},
    {"feedback_fresh", [](const AxisRecord& a, Line& l) { l.Field(a.feedback.fresh); }},
    {"extra_torque_Nm", [](const AxisRecord& a, Line& l) { l.Field(a.reference.extra_torque_Nm); }},
    {"spring_N_m", [](const AxisRecord& a, Line& l) { l.Field(a.reference.spring_N_m); }},
};

}  // namespace

CycleCsv::CycleCsv(std::span<const std::string> axis_names, int cycle_us,
                   std::span<const std::string> columns)
    : cycle_us_(cycle_us) {
  for (std::size_t i = 0; i < std::size(kCycleColumns); ++i)
    columns_.push_back({std::string(kCycleColumns[i].name), kNoAxis, i});
  for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
    for (std::size_t i = 0; i < std::size(kAxisColumns); ++i)
      columns_.push_back({axis_names[axis] + '_' + std::string(kAxisColumns[i].name), axis, i});
  }
  if (columns.empty()) return;
  std::vector<Column> chosen;
  for (const std::string& name : columns) {
    const auto found = std::find_if(columns_.begin(), columns_.end(),
                                    [&](const Column& column) { return column.name == name; });
    if (found == columns_.end())
      throw std::invalid_argument("the table of cycles has no column '" + name + "'");
    chosen.push_back(*found);
  }
  columns_ = std::move(chosen);
}

std::string CycleCsv::Header() const {
  std::string out;
  Line line(out);
  for (const Column& column : columns_) line.Field(column.name);
  return out += '\n';
}

void CycleCsv::AppendRow(const CycleRecord& record, const CycleTiming& timing, std::string& out) const {
  static const AxisRecord kNothing;
  // One division, so that 3 cycles of 1000 us print as 0.003 and not as a neighbour of it.
  const double time_s = (static_cast<double>(record.cycle) - 1.0) * cycle_us_ / 1e6;
  const Row row{record, timing, time_s};
  Line line(out);
  for (const Column& column : columns_) {
    if (column.axis == kNoAxis) {
      kCycleColumns[column.index].write(row, line);
    } else {
      kAxisColumns[column.index].write(column.axis < record.axes.size() ? record.axes[column.axis] : kNothing,
                                       line);
    }
  }
  out += '\n';
}

}  // namespace contour
