#include "analysis/parallel/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <list>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace contour {
namespace {

/// One call of ParallelFor.
struct Job {
  std::size_t count = 0;
  const std::function<void(std::size_t)>* body = nullptr;
  std::atomic<std::size_t> next{0};
  int wanted = 0;   ///< threads that may still join; under the pool's mutex, as are the others below
  int working = 0;  ///< that have joined
  std::exception_ptr error;

  /// Until nothing is left.
  std::exception_ptr Work() {
    try {
      for (std::size_t i = next++; i < count; i = next++) (*body)(i);
    } catch (...) {
      next = count;
      return std::current_exception();
    }
    return nullptr;
  }
};

class Pool {
 public:
  static Pool& Only() {
    static Pool pool;
    return pool;
  }

  ~Pool() {
    {
      const std::scoped_lock lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    for (std::thread& t : threads_) t.join();
  }

  void Run(Job& job) {
    {
      const std::scoped_lock lock(mutex_);
      while (static_cast<int>(threads_.size()) < job.wanted) threads_.emplace_back([this] { Serve(); });
      jobs_.push_back(&job);
    }
    changed_.notify_all();
    const std::exception_ptr error = job.Work();
    std::unique_lock lock(mutex_);
    jobs_.remove(&job);
    changed_.wait(lock, [&] { return job.working == 0; });
    if (error) job.error = error;
  }

 private:
  void Serve() {
    std::unique_lock lock(mutex_);
    for (;;) {
      std::list<Job*>::iterator open;
      changed_.wait(lock, [&] {
        open = std::find_if(jobs_.begin(), jobs_.end(), [](const Job* j) { return j->wanted > 0; });
        return ending_ || open != jobs_.end();
      });
      if (ending_) return;
      Job& job = **open;
      --job.wanted;
      ++job.working;
      lock.unlock();
      const std::exception_ptr error = job.Work();
      lock.lock();
      if (error && !job.error) job.error = error;
      if (--job.working == 0) changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::list<Job*> jobs_;
  std::vector<std::thread> threads_;
  bool ending_ = false;
};

}  // namespace

void ParallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& body) {
  Job job;
  job.count = count;
  job.body = &body;
  job.wanted =
      static_cast<int>(std::min<std::size_t>(count, static_cast<std::size_t>(std::max(1, threads)))) - 1;
  if (job.wanted > 0)
    Pool::Only().Run(job);
  else
    job.error = job.Work();
  if (job.error) std::rethrow_exception(job.error);
}

int ThreadsOf(int asked) {
  return asked > 0 ? asked : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace contour
