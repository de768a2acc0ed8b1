#include "tools/validation/contest/run_cells.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace contour {

std::vector<CellResult> RunCells(const std::vector<ContestCell>& cells, unsigned workers,
                                 const std::function<void(std::size_t)>& done,
                                 const std::function<void(std::size_t, const CellResult&)>& one) {
  std::vector<CellResult> results(cells.size());
  std::atomic<std::size_t> next{0};
  std::size_t finished = 0;
  std::size_t idle = 0;
  std::exception_ptr error;
  std::mutex mutex;
  std::condition_variable changed;
  const auto work = [&] {
    for (std::size_t i = next++; i < cells.size(); i = next++) {
      std::exception_ptr wrong;
      try {
        results[i] = RunCell(cells[i]);
      } catch (...) {
        wrong = std::current_exception();
        next = cells.size();
      }
      const std::lock_guard lock(mutex);
      try {
        if (!wrong && one) one(i, results[i]);
      } catch (...) {
        wrong = std::current_exception();
        next = cells.size();
      }
      if (wrong && !error) error = wrong;
      ++finished;
    }
    const std::lock_guard lock(mutex);
    ++idle;
    changed.notify_one();
  };
  std::vector<std::jthread> threads;
  const std::size_t count = std::clamp<std::size_t>(workers, 1, std::max<std::size_t>(1, cells.size()));
  for (std::size_t i = 0; i < count; ++i) threads.emplace_back(work);
  {
    std::unique_lock lock(mutex);
    while (!changed.wait_for(lock, std::chrono::milliseconds(250), [&] { return idle == count; }))
      if (done) done(finished);
  }
  threads.clear();
  if (error) std::rethrow_exception(error);
  if (done) done(cells.size());
  return results;
}

}  // namespace contour
