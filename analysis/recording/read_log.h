#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/recording/axis_log.h"
#include "analysis/recording/log_columns.h"

namespace contour::diagnosis {

/// How a log is to be read.
struct ReadOptions {
  std::string axis{};        ///< empty: the only one
  ColumnNames columns{};     ///< of a table
  double table_per_q = 1.0;  ///< m per unit of q, for what a table states at the table
  /// [Hz] Puts rows that come as they come on a grid of this rate; 0: they must be on one.
  double resample_Hz = 0.0;
  /// [Hz] Of a table without times; 0: it must have them.
  double sample_rate_Hz = 0.0;
};

/// A log of contourd, or a table (docs/diagnosis_files.md has the columns). Rows go to the grid of the
/// table's own period; a grid point without a row, or whose row has no new position, is not present. Throws
/// ConfigError with file and line for what cannot be read.
AxisLog ReadLog(const std::string& file, const ReadOptions& options);

AxisLog ReadCsvLog(const std::string& file, const ReadOptions& options);
AxisLog ReadDaemonLog(const std::string& file, const ReadOptions& options);

/// Whether the file is a log of contourd.
bool IsDaemonLog(const std::string& file);

/// Several logs of one axis as one: one after the other, half a second of grid points without rows between
/// (and more than IsGap asks for).
/// Columns that not all of them have are left out. Throws ConfigError when they are of different kinds.
AxisLog JoinLogs(std::vector<AxisLog> logs);

}  // namespace contour::diagnosis
