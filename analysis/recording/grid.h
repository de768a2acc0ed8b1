#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace contour::diagnosis {

/// The grid that the times of a table lie on.
struct Grid {
  double period_s = 0.0;
  std::vector<std::size_t> index;  ///< of each row, beginning with 0
};

/// Period: the median step, then the mean over what has no gaps. After a gap (IsGap) the grid begins anew at
/// the next row. Throws ConfigError with the line where time stands still, goes back, or is more than a
/// quarter of a period off the grid. `line[i]` is the line of row i.
Grid FindGrid(const std::string& file, const std::vector<double>& time_s,
              const std::vector<std::size_t>& line);

/// Time that goes on; throws ConfigError with the line where it does not.
void DemandRisingTime(const std::string& file, const std::vector<double>& time_s,
                      const std::vector<std::size_t>& line);

}  // namespace contour::diagnosis
