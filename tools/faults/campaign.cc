#include "tools/faults/campaign.h"

#include <exception>
#include <mutex>

#include "analysis/parallel/parallel_for.h"

namespace contour::faults {
namespace {

RunResult RunOne(const FaultCase& c, const RunRequest& request) {
  try {
    return RunFault(c, request);
  } catch (const std::exception& e) {
    RunResult failed;
    failed.c = c;
    failed.violations.push_back(std::string("the run could not be made: ") + e.what());
    return failed;
  }
}

}  // namespace

std::vector<RunResult> RunCampaign(const std::vector<FaultCase>& cases, const RunRequest& request,
                                   unsigned threads, const std::function<void(std::size_t)>& progress) {
  std::vector<RunResult> results(cases.size());
  std::mutex mutex;
  std::size_t done = 0;
  ParallelFor(cases.size(), static_cast<int>(threads), [&](std::size_t i) {
    results[i] = RunOne(cases[i], request);
    const std::scoped_lock lock(mutex);
    ++done;
    if (progress) progress(done);
  });
  return results;
}

}  // namespace contour::faults
