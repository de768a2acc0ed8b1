#include "analysis/recording/table_rows.h"

#include <cmath>
#include <limits>
#include <optional>

#include "config/config_error.h"

namespace contour::diagnosis {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TableRows ReadTableRows(const CsvTable& table, const LogColumns& columns, double sample_rate_Hz) {
  TableRows rows;
  using Fields = std::vector<std::string_view>;
  const auto number = [&](const Fields& fields, std::size_t line, const LogColumn& column) {
    return column.factor * table.Number(fields[column.at], line, column.at);
  };
  table.ForEachRow([&](std::size_t line, const Fields& fields) {
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
