#include <cmath>
#include <limits>

#include "analysis/recording/csv_table.h"
#include "analysis/recording/grid.h"
#include "analysis/recording/read_log.h"
#include "config/config_error.h"

namespace contour::diagnosis {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The rows of a table as they stand, NaN where a field is empty.
struct Rows {
  std::vector<std::size_t> line;
  std::vector<double> time_s, command, position, table_position, temperature, axis2, reference;
};

Rows ReadRows(const CsvTable& table, const LogColumns& columns) {
  Rows rows;
  const auto number = [&](const std::vector<std::string_view>& fields, std::size_t line, std::size_t column) {
    return NumberOf(fields[column], table.file(), line, table.header()[column]);
  };
  const auto add = [&](std::vector<double>& to, const std::optional<std::size_t>& column,
                       const std::vector<std::string_view>& fields, std::size_t line) {
    if (column) to.push_back(number(fields, line, *column));
  };
  table.ForEachRow([&](std::size_t line, const std::vector<std::string_view>& fields) {
    const double time = number(fields, line, columns.time);
    if (std::isnan(time))
      throw ConfigError({table.file() + ":" + std::to_string(line) + ": time_s: is empty"});
    rows.line.push_back(line);
    rows.time_s.push_back(time);
    rows.command.push_back(number(fields, line, columns.command));
    const bool off = columns.drive_state && fields[*columns.drive_state] != "Operation Enabled";
    const bool old = columns.fresh && (fields[*columns.fresh] == "0" || fields[*columns.fresh] == "false");
    rows.position.push_back(off || old ? kNone : number(fields, line, columns.position));
    add(rows.table_position, columns.table_position, fields, line);
    add(rows.temperature, columns.temperature, fields, line);
    add(rows.axis2, columns.axis2_position, fields, line);
    add(rows.reference, columns.reference, fields, line);
  });
  return rows;
}

/// Values on the grid; where there is no row the one before goes on when `hold`.
std::vector<double> OnGrid(const Grid& grid, const std::vector<double>& values, bool hold) {
  if (values.empty()) return {};
  std::vector<double> out(grid.index.back() + 1, kNone);
  for (std::size_t i = 0; i < values.size(); ++i) out[grid.index[i]] = values[i];
  double last = kNone;
  for (const double v : values)
    if (!std::isnan(v)) {
      last = v;  // before the first, the first
      break;
    }
  if (std::isnan(last)) return {};  // a column without any number is no column
  for (double& v : out) {
    if (!std::isnan(v)) last = v;
    if (hold) v = last;
  }
  return out;
}

}  // namespace

AxisLog ReadCsvLog(const std::string& file, const ReadOptions& options) {
  const CsvTable table(file);
  const LogColumns columns = FindColumns(file, table.header(), options.axis, options.columns);
  Rows rows = ReadRows(table, columns);
  const Grid grid = FindGrid(file, rows.time_s, rows.line);
  if (columns.reference_in_m && !columns.linear)
    for (double& r : rows.reference) r /= options.table_per_q;

  AxisLog log;
  log.source = file;
  log.axis = options.axis;
  log.linear = columns.linear;
  log.period_s = grid.period_s;
  log.rows = rows.time_s.size();
  log.command = OnGrid(grid, rows.command, true);
  log.position = OnGrid(grid, rows.position, false);
  if (log.command.empty() || log.position.empty())
    throw ConfigError(
        {file + ": the columns of command and position hold no number in which the drive was on"});
  log.table_position_m = OnGrid(grid, rows.table_position, false);
  log.temperature_degC = OnGrid(grid, rows.temperature, true);
  log.axis2_position_m = OnGrid(grid, rows.axis2, true);
  log.reference_position = OnGrid(grid, rows.reference, true);
  log.missing = log.size() - log.rows;
  for (const double q : log.position) log.present.push_back(std::isnan(q) ? 0 : 1);
  return log;
}

}  // namespace contour::diagnosis
