#pragma once

#include <functional>
#include <vector>

#include "tools/faults/fault_run.h"

namespace contour::faults {

/// Runs the cases on so many threads; results in the order of the cases. `progress` is called with the number
/// of runs that are over, one thread at a time. A run that cannot even be made is a violation of its own.
std::vector<RunResult> RunCampaign(const std::vector<FaultCase>& cases, const RunRequest& request,
                                   unsigned threads,
                                   const std::function<void(std::size_t done)>& progress = {});

}  // namespace contour::faults
