#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace contour::diagnosis {

/// `--columns time_s=t_s,force_N=force_N`: our name of a quantity, and the header it has in the file.
using ColumnNames = std::map<std::string, std::string>;

/// Throws ConfigError for what does not have that form and for quantities that are not known.
ColumnNames ParseColumnNames(const std::string& text);

/// Where the quantities of an axis stand in a table: the number of the column.
struct LogColumns {
  bool linear = false;
  std::size_t time = 0;
  std::size_t command = 0;
  std::size_t position = 0;
  std::optional<std::size_t> table_position, temperature, axis2_position, reference;
  bool reference_in_m = false;
  // Of our own tables: whether the drive turned torque into motion, and whether the position is of this row.
  std::optional<std::size_t> drive_state, fresh;
};

/// Finds them in a header: by `names`, else by our own spelling (torque_Nm, motor_angle_rad, ...), small and
/// capital letters alike, with `axis` and an underscore before it or without. A table with force_N and
/// position_m is of a linear axis. Throws ConfigError, naming what is missing and what there is.
LogColumns FindColumns(const std::string& file, const std::vector<std::string>& header,
                       const std::string& axis, const ColumnNames& names);

}  // namespace contour::diagnosis
