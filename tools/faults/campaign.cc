#include "tools/faults/campaign.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

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
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::size_t done = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < cases.size(); i = next++) {
      results[i] = RunOne(cases[i], request);
      const std::scoped_lock lock(mutex);
      ++done;
      if (progress) progress(done);
    }
  };
  std::vector<std::jthread> pool;
  for (unsigned t = 1; t < std::max(1U, threads); ++t) pool.emplace_back(work);
  work();
  pool.clear();
  return results;
}

}  // namespace contour::faults
