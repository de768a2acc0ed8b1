#include "analysis/recording/table_rows.h"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "config/config_error.h"

namespace contour::diagnosis {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A date or a time of day, as many loggers write it.
void DemandSeconds(const CsvTable& table, std::string_view field, std::size_t line) {
  if (field.find(':') == std::string_view::npos) return;
  throw ConfigError(
      {table.file() + ":" + std::to_string(line) + ": time_s: found '" + std::string(field) +
       "', a date or a time of day, expected seconds as a number: write seconds since the first "
       "row, or, where rows come at a fixed rate, take the column out and state it by "
       "--sample-rate HZ"});
}

}  // namespace

TableRows ReadTableRows(const CsvTable& table, const LogColumns& columns, double sample_rate_Hz) {
  TableRows rows;
  using Fields = std::vector<std::string_view>;
  const auto number = [&](const Fields& fields, std::size_t line, const LogColumn& column) {
    return column.factor * table.Number(fields[column.at], line, column.at);
  };
  table.ForEachRow([&](std::size_t line, const Fields& fields) {
    if (columns.time) DemandSeconds(table, fields[columns.time->at], line);
    const auto add = [&](std::vector<double>& to, const std::optional<LogColumn>& column) {
      if (column) to.push_back(number(fields, line, *column));
    };
    const double time = columns.time ? number(fields, line, *columns.time)
                                     : static_cast<double>(rows.time_s.size()) / sample_rate_Hz;
    if (std::isnan(time))
      throw ConfigError({table.file() + ":" + std::to_string(line) + ": time_s: is empty"});
    rows.line.push_back(line);
    rows.time_s.push_back(time);
    rows.command.push_back(number(fields, line, columns.command));
    const bool off = columns.drive_state && fields[columns.drive_state->at] != "Operation Enabled";
    const bool old =
        columns.fresh && (fields[columns.fresh->at] == "0" || fields[columns.fresh->at] == "false");
    add(rows.position, columns.position);
    if ((off || old) && columns.position) rows.position.back() = kNone;
    add(rows.velocity, columns.velocity);
    add(rows.table_position, columns.table_position);
    add(rows.temperature, columns.temperature);
    add(rows.axis2, columns.axis2_position);
    add(rows.reference, columns.reference);
  });
  return rows;
}

}  // namespace contour::diagnosis
