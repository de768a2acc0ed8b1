#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace contour::diagnosis {

/// `--columns time_s=t_s,force_N=u*35.15`: our name of a quantity, and the header it has in the file; with a
/// factor to the unit of our name where it takes one. Columns without a header have their number from 1.
using ColumnNames = std::map<std::string, std::string>;

/// Throws ConfigError for what does not have that form and for quantities that are not known.
ColumnNames ParseColumnNames(const std::string& text);

/// Where a quantity stands in a table: the number of the column, and the factor to our unit.
struct LogColumn {
  std::size_t at = 0;
  double factor = 1.0;
  bool operator==(std::size_t column) const { return at == column; }
};

/// Where the quantities of an axis stand.
struct LogColumns {
  bool linear = false;
  bool in_ampere = false;      ///< the command is a current
  bool measured = false;       ///< what acted at the instant of the row, in place of what was commanded there
  bool position_in_m = false;  ///< of a rotary axis: at the table
  std::optional<LogColumn> time;  ///< none: rows come at a rate that is stated
  LogColumn command;
  std::optional<LogColumn> position;  ///< none: the integral of the velocity
  std::optional<LogColumn> velocity;
  std::optional<LogColumn> table_position, temperature, axis2_position, reference;
  bool reference_in_m = false;
  // Of our own tables: whether the drive turned torque into motion, and whether the position is of this row.
  std::optional<LogColumn> drive_state, fresh;
};

/// Finds them in a header: by `names`, else by our own spelling (torque_Nm, motor_angle_rad, ...), small and
/// capital letters alike, with `axis` and an underscore before it or without. A table with force_N and
/// position_m is of a linear axis. Throws ConfigError, naming what is missing and what there is; without a
/// time only where `rate_stated` is not set.
LogColumns FindColumns(const std::string& file, const std::vector<std::string>& header,
                       const std::string& axis, const ColumnNames& names, bool rate_stated = false);

}  // namespace contour::diagnosis
