#include "daemon/lanes/slow_lane.h"

#include <pthread.h>

#include <condition_variable>
#include <csignal>
#include <cstdint>
#include <deque>
#include <exception>
#include <mutex>
#include <utility>

namespace contour {
namespace {

struct Piece {
  std::size_t bytes;
  std::function<void()> work;
};

}  // namespace

struct SlowLane::Shared {
  mutable std::mutex mutex;  // guards all below; never held while work is done
  std::condition_variable wake;
  std::condition_variable progress;
  std::deque<Piece> waiting;
  std::size_t bytes = 0;  ///< of what waits and what is being done
  std::uint64_t done = 0;
  bool out_of_patience = false;
  bool ending = false;
  bool abandoned = false;
  bool ended = false;
};

SlowLane::SlowLane(const char* name, Limits limits) : limits_(limits), shared_(std::make_shared<Shared>()) {
  // Signals are the main thread's.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([shared = shared_] { Work(shared); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  pthread_setname_np(thread_.native_handle(), name);
}

SlowLane::~SlowLane() { Finish(std::chrono::steady_clock::now()); }

bool SlowLane::Post(std::size_t bytes, std::function<void()> work, std::size_t beyond) {
  {
    std::unique_lock lock(shared_->mutex);
    const auto fits = [&] {
      return shared_->bytes == 0 || shared_->bytes + bytes <= limits_.max_bytes + beyond;
    };
    while (!fits() && !shared_->ending && limits_.patience.count() > 0 && !shared_->out_of_patience) {
      const std::uint64_t before = shared_->done;
      shared_->out_of_patience = !shared_->progress.wait_for(
          lock, limits_.patience, [&] { return shared_->done != before || shared_->ending; });
    }
    if (!fits() || shared_->ending) return false;
    shared_->bytes += bytes;
    shared_->waiting.push_back({bytes, std::move(work)});
  }
  shared_->wake.notify_one();
  return true;
}

bool SlowLane::Finish(std::chrono::steady_clock::time_point deadline) {
  if (!thread_.joinable()) return !shared_->abandoned;
  bool ended = false;
  {
    std::unique_lock lock(shared_->mutex);
    shared_->ending = true;
    shared_->wake.notify_one();
    shared_->progress.notify_all();
    ended = shared_->progress.wait_until(lock, deadline, [this] { return shared_->ended; });
    // Should it come loose after all, it does nothing more.
    shared_->abandoned = !ended;
  }
  if (ended) {
    thread_.join();
  } else {
    thread_.detach();
  }
  return ended;
}

std::size_t SlowLane::waiting_bytes() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->bytes;
}

void SlowLane::Work(const std::shared_ptr<Shared>& shared) {
  std::unique_lock lock(shared->mutex);
  for (;;) {
    shared->wake.wait(lock, [&] { return shared->ending || !shared->waiting.empty(); });
    if (shared->abandoned || shared->waiting.empty()) break;
    Piece piece = std::move(shared->waiting.front());
    shared->waiting.pop_front();
    lock.unlock();
    try {
      piece.work();
    } catch (const std::exception&) {
      // Whoever handed it over counts what comes of it; the lane goes on.
    }
    piece.work = nullptr;
    lock.lock();
    shared->bytes -= piece.bytes;
    ++shared->done;
    shared->out_of_patience = false;
    shared->progress.notify_all();
  }
  shared->waiting.clear();
  shared->ended = true;
  shared->progress.notify_all();
}

}  // namespace contour
