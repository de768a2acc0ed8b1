#pragma once

#include <string>
#include <vector>

#include "tools/faults/fault_run.h"

namespace contour::faults {

/// One cell of the table: all runs of a fault in a phase and, in motion, a band of feeds.
struct Cell {
  Fault fault = Fault::kFeedbackFrameLost;
  Phase phase = Phase::kBringUp;
  std::size_t band = 0;
  std::size_t runs = 0;
  std::size_t stopped = 0;
  std::size_t failed = 0;
  RunResult farthest;  ///< the largest share of its bound
  double time_s = 0.0;
  double time_bound_s = 0.0;         ///< of the run with that time
  std::vector<std::string> reasons;  ///< seen, most frequent first not promised
};

/// Cells that have runs, in the order of faults, phases and bands. `highest_mm_s` by axis number.
std::vector<Cell> Cells(const std::vector<RunResult>& results, const std::vector<double>& highest_mm_s);

std::string TableText(const std::vector<Cell>& cells, const std::vector<double>& highest_mm_s);
std::string TableMarkdown(const std::vector<Cell>& cells, const std::vector<double>& highest_mm_s);
std::string TableCsv(const std::vector<Cell>& cells);
/// A row for each run, failed or not.
std::string RunsCsv(const std::vector<RunResult>& results);
/// What was violated, each with the command that repeats it.
std::string Failures(const std::vector<RunResult>& results, const std::string& config, std::uint64_t seed,
                     const std::string& without);

}  // namespace contour::faults
