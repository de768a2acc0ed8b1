#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>

#include "analysis/recording/read_log.h"
#include "config/config_error.h"
#include "daemon/telemetry/log_reader.h"

namespace contour::diagnosis {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::size_t AxisNumber(const LogHeader& header, const std::string& file, const std::string& axis) {
  const auto& names = header.axis_names;
  std::string all;
  for (const std::string& n : names) all += (all.empty() ? "" : ", ") + n;
  if (axis.empty()) {
    if (names.size() == 1) return 0;
    throw ConfigError({file + ": holds the axes " + all + "; say by --axis which one"});
  }
  const auto at = std::find(names.begin(), names.end(), axis);
  if (at == names.end()) throw ConfigError({"--axis: found '" + axis + "', but " + file + " holds " + all});
  return static_cast<std::size_t>(at - names.begin());
}

/// Rows up to `size` that no cycle filled: the drive goes on with its last command.
void Resize(AxisLog& log, std::size_t size) {
  log.command.resize(size, log.command.empty() ? 0.0 : log.command.back());
  log.position.resize(size, kNone);
  log.present.resize(size, 0);
  log.table_position_m.resize(size, kNone);
  log.temperature_degC.resize(size, log.temperature_degC.empty() ? kNone : log.temperature_degC.back());
  log.axis2_position_m.resize(size, log.axis2_position_m.empty() ? kNone : log.axis2_position_m.back());
  log.reference_position.resize(size, log.reference_position.empty() ? kNone : log.reference_position.back());
}

/// Cycle k holds the feedback that SYNC k-1 latched and the torque computed from it, which the drive takes at
/// SYNC k: one row of an AxisLog, whose delay is then one period.
void Fill(AxisLog& log, const CycleRecord& record, std::size_t axis, double radius_m_rad) {
  const AxisRecord& a = record.axes[axis];
  log.command.back() = a.torque_Nm;
  if (a.feedback.fresh && a.feedback.drive_state == DriveState::kOperationEnabled) {
    log.position.back() = a.feedback.position_rad;
    log.present.back() = 1;
    if (a.feedback.has_scale) log.table_position_m.back() = a.feedback.table_position_m;
  }
  if (record.io.configured && record.io.fresh && !std::isnan(record.io.screw_temperature_degC))
    log.temperature_degC.back() = record.io.screw_temperature_degC;
  log.reference_position.back() = a.reference.position_m / radius_m_rad;
  if (record.axes.size() > 1) log.axis2_position_m.back() = record.axes[axis == 0 ? 1 : 0].position_m;
}

/// A column without any value is no column.
void DropEmpty(std::vector<double>& column) {
  if (std::all_of(column.begin(), column.end(), [](double v) { return std::isnan(v); })) column.clear();
}

/// What was known first also holds before.
void FillFront(std::vector<double>& column) {
  const auto first = std::find_if(column.begin(), column.end(), [](double v) { return !std::isnan(v); });
  if (first != column.end()) std::fill(column.begin(), first, *first);
}

/// Only the part in which the drive was on.
template <class T>
void Cut(std::vector<T>& column, std::size_t from, std::size_t to) {
  if (column.empty()) return;
  column.erase(column.begin() + static_cast<std::ptrdiff_t>(to), column.end());
  column.erase(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(from));
}

}  // namespace

bool IsDaemonLog(const std::string& file) {
  // LCM's event logs begin with this sync word (lcm/eventlog.h).
  std::ifstream in(file, std::ios::binary);
  unsigned char word[4] = {};
  in.read(reinterpret_cast<char*>(word), 4);
  return in && word[0] == 0xED && word[1] == 0xA1 && word[2] == 0xDA && word[3] == 0x01;
}

AxisLog ReadDaemonLog(const std::string& file, const ReadOptions& options) {
  AxisLog log;
  log.source = file;
  std::size_t rows = 0;
  try {
    LogReader reader(file);
    if (reader.header().controller == "csp")
      throw ConfigError({file +
                         ": was recorded with the controller csp, in which the drive makes the torque: "
                         "record it in torque mode"});
    const std::size_t axis = AxisNumber(reader.header(), file, options.axis);
    log.axis = reader.header().axis_names[axis];
    log.period_s = reader.header().cycle_us * 1e-6;
    auto entry = std::make_unique<CycleEntry>();
    std::optional<std::uint64_t> first;
    while (reader.Next(*entry)) {
      const CycleRecord& record = entry->output.record;
      if (axis >= record.axes.size()) continue;
      if (!first) first = record.cycle;
      Resize(log, static_cast<std::size_t>(record.cycle - *first) + 1);
      Fill(log, record, axis, options.table_per_q);
    }
  } catch (const LogError& e) {
    throw ConfigError({e.what()});
  }
  const auto on = std::find(log.present.begin(), log.present.end(), 1);
  if (on == log.present.end())
    throw ConfigError({file + ": holds no cycle in which the drive of this axis was enabled"});
  const auto from = static_cast<std::size_t>(on - log.present.begin());
  const auto to =
      static_cast<std::size_t>(log.present.rend() - std::find(log.present.rbegin(), log.present.rend(), 1));
  Cut(log.present, from, to);
  for (auto* column : {&log.command, &log.position, &log.table_position_m, &log.temperature_degC,
                       &log.axis2_position_m, &log.reference_position})
    Cut(*column, from, to);
  FillFront(log.temperature_degC);
  for (auto* column : {&log.table_position_m, &log.temperature_degC, &log.axis2_position_m})
    DropEmpty(*column);
  rows = static_cast<std::size_t>(std::count(log.present.begin(), log.present.end(), 1));
  log.rows = rows;
  log.missing = log.size() - rows;
  return log;
}

AxisLog ReadLog(const std::string& file, const ReadOptions& options) {
  return IsDaemonLog(file) ? ReadDaemonLog(file, options) : ReadCsvLog(file, options);
}

}  // namespace contour::diagnosis
