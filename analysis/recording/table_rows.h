#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/recording/csv_table.h"
#include "analysis/recording/grid.h"
#include "analysis/recording/log_columns.h"

namespace contour::diagnosis {

/// The rows of a table as they stand, in our units, NaN where a field is empty. Columns that a table has not
/// are empty.
struct TableRows {
  std::vector<std::size_t> line;
  std::vector<double> time_s, command, position, velocity, table_position, temperature, axis2, reference;

  /// All that may be interpolated.
  static constexpr std::vector<double> TableRows::*kStates[] = {
      &TableRows::position,    &TableRows::velocity, &TableRows::table_position,
      &TableRows::temperature, &TableRows::axis2,    &TableRows::reference};
};

/// `sample_rate_Hz`: of a table without times.
TableRows ReadTableRows(const CsvTable& table, const LogColumns& columns, double sample_rate_Hz);

/// The same rows on a grid of that rate, beginning anew after each gap: positions on cubics through the rows
/// about, the command as the mean of what acts over each new row (held from row to row where it was
/// commanded, straight from row to row where it was measured). `note` says what was done. Throws ConfigError
/// where time does not go on.
TableRows Resample(const std::string& file, const TableRows& rows, bool measured, double rate_Hz, Grid& grid,
                   std::string& note);

}  // namespace contour::diagnosis
