#include "daemon/rt/thread_accounting.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <charconv>

#include "drivers/can/clock_ns.h"

namespace contour {
namespace {

/// The number behind `skip` blanks of a file's first line; -1 when there is none.
std::int64_t NumberIn(const char* text, std::size_t length, int skip) noexcept {
  const char* at = text;
  const char* end = text + length;
  for (; at != end && skip > 0; ++at)
    if (*at == ' ') --skip;
  std::int64_t value = -1;
  std::from_chars(at, end, value);
  return value;
}

std::int64_t ReadNumber(const char* file) noexcept {
  std::array<char, 64> text;
  const int fd = ::open(file, O_RDONLY | O_CLOEXEC);
  if (fd < 0) return -1;
  const ssize_t n = ::read(fd, text.data(), text.size());
  ::close(fd);
  return n > 0 ? NumberIn(text.data(), static_cast<std::size_t>(n), 0) : -1;
}

}  // namespace

ThreadAccounting::ThreadAccounting() noexcept
    : schedstat_(::open("/proc/thread-self/schedstat", O_RDONLY | O_CLOEXEC)) {
  static_cast<void>(Read());
  static_cast<void>(RunDelay_ns());
  static_cast<void>(OffCpu_ns());
}

ThreadAccounting::~ThreadAccounting() {
  if (schedstat_ >= 0) ::close(schedstat_);
}

ThreadCounts ThreadAccounting::Read() noexcept {
  rusage usage{};
  if (::getrusage(RUSAGE_THREAD, &usage) != 0) return {};
  const auto faults = static_cast<std::uint64_t>(usage.ru_minflt + usage.ru_majflt);
  const auto involuntary = static_cast<std::uint64_t>(usage.ru_nivcsw);
  const auto voluntary = static_cast<std::uint64_t>(usage.ru_nvcsw);
  const ThreadCounts since{static_cast<std::uint32_t>(faults - faults_),
                           static_cast<std::uint32_t>(involuntary - involuntary_),
                           static_cast<std::uint32_t>(voluntary - voluntary_)};
  faults_ = faults;
  involuntary_ = involuntary;
  voluntary_ = voluntary;
  return since;
}

std::int64_t ThreadAccounting::RunDelay_ns() noexcept {
  if (schedstat_ < 0) return 0;
  // "time on the CPU" "time ready and waiting" "number of slices"
  std::array<char, 96> text;
  const ssize_t n = ::pread(schedstat_, text.data(), text.size(), 0);
  if (n <= 0) return 0;
  const std::int64_t now = NumberIn(text.data(), static_cast<std::size_t>(n), 1);
  if (now < 0) return 0;
  const std::int64_t since = now - run_delay_ns_;
  run_delay_ns_ = now;
  return since;
}

std::int64_t ThreadAccounting::OffCpu_ns() noexcept {
  const std::int64_t now = ClockNow_ns() - ClockNow_ns(CLOCK_THREAD_CPUTIME_ID);
  const std::int64_t since = now - off_cpu_ns_;
  off_cpu_ns_ = now;
  return since;
}

std::int64_t ThrottleTime_ns() noexcept {
  const std::int64_t runtime_us = ReadNumber("/proc/sys/kernel/sched_rt_runtime_us");
  const std::int64_t period_us = ReadNumber("/proc/sys/kernel/sched_rt_period_us");
  return runtime_us > 0 && period_us > runtime_us ? 1000 * (period_us - runtime_us) : 0;
}

}  // namespace contour
