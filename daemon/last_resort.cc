#include "daemon/last_resort.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include "daemon/logging/logging.h"

namespace contour {
namespace {

constexpr std::chrono::seconds kLastLines{1};

}  // namespace

LastResort::LastResort(std::chrono::seconds limit, int exit_status)
    : thread_([this, limit, exit_status] { Watch(limit, exit_status); }) {}

LastResort::~LastResort() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void LastResort::Now(const char* what) {
  const std::lock_guard lock(mutex_);
  what_ = what;
}

void LastResort::Watch(std::chrono::seconds limit, int exit_status) {
  std::unique_lock lock(mutex_);
  if (!wake_.wait_for(lock, limit, [this] { return ended_; })) End(what_, exit_status);
}

void LastResort::End(const char* what, int exit_status) {
  spdlog::error("ends without waiting any longer for: {}", what);
  FinishLogging(std::chrono::steady_clock::now() + kLastLines);
  ::_exit(exit_status);
}

}  // namespace contour
