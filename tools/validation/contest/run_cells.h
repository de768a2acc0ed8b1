#pragma once

#include <functional>
#include <vector>

#include "tools/validation/contest/contest_cell.h"

namespace contour {

/// Runs all cells on `workers` threads; results in the order of the cells, the same for any number of
/// workers. `done` is told now and then how many are finished, from the calling thread. Rethrows the first
/// ConfigError. `one` has each result as it comes, from the threads, one call at a time.
std::vector<CellResult> RunCells(const std::vector<ContestCell>& cells, unsigned workers,
                                 const std::function<void(std::size_t)>& done = {},
                                 const std::function<void(std::size_t, const CellResult&)>& one = {});

}  // namespace contour
