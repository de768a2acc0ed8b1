#include "daemon/rt/thread_setup.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace contour {
namespace {

std::string LimitText(rlim_t value) { return value == RLIM_INFINITY ? "unlimited" : std::to_string(value); }

std::string WhyNoPriority(int priority, int error) {
  rlimit limit{};
  getrlimit(RLIMIT_RTPRIO, &limit);
  std::string text =
      "SCHED_FIFO priority " + std::to_string(priority) + " refused (" + std::strerror(error) + "): ";
  if (error == EPERM && limit.rlim_cur < static_cast<rlim_t>(priority)) {
    return text + "RLIMIT_RTPRIO is " + LimitText(limit.rlim_cur) +
           "; set LimitRTPRIO=" + std::to_string(priority) +
           " in the systemd unit, or 'rtprio' in /etc/security/limits.conf";
  }
  std::ifstream runtime("/sys/fs/cgroup/cpu/cpu.rt_runtime_us");
  if (error == EPERM && runtime) {
    return text +
           "the kernel schedules real-time groups (CONFIG_RT_GROUP_SCHED) and this control group has no "
           "real-time "
           "budget; give it cpu.rt_runtime_us or boot with rt_group_sched=0";
  }
  return text + "check RLIMIT_RTPRIO (now " + LimitText(limit.rlim_cur) +
         ") and the control group's real-time budget";
}

std::string WhyNoLock(int error) {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  return std::string("mlockall refused (") + std::strerror(error) + "): RLIMIT_MEMLOCK is " +
         LimitText(limit.rlim_cur) +
         " bytes; set LimitMEMLOCK=infinity in the systemd unit, or 'memlock' in /etc/security/limits.conf";
}

/// Touches the stack once so that the cycle never faults a page in.
void PrefaultStack(std::size_t bytes) {
  constexpr std::size_t kChunk = 64 * 1024;
  std::array<volatile char, kChunk> chunk;
  const long page = sysconf(_SC_PAGESIZE);
  for (std::size_t i = 0; i < kChunk; i += static_cast<std::size_t>(page)) chunk[i] = 0;
  if (bytes > kChunk) PrefaultStack(bytes - kChunk);
  chunk[0] = 0;  // keeps the recursion from becoming a loop that reuses one frame
}

}  // namespace

std::vector<std::string> ApplyThreadRequest(const ThreadRequest& request) {
  std::vector<std::string> refused;
  if (request.cpu >= 0) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(request.cpu), &set);
    if (const int error = pthread_setaffinity_np(pthread_self(), sizeof set, &set); error != 0) {
      refused.push_back(
          "CPU " + std::to_string(request.cpu) + " refused (" + std::strerror(error) +
          "): this machine has " + std::to_string(sysconf(_SC_NPROCESSORS_ONLN)) +
          " CPUs on line; correct realtime.cpu in the machine file, or CPUAffinity= in the systemd unit");
    }
  }
  if (request.lock_memory && mlockall(MCL_CURRENT | MCL_FUTURE) != 0) refused.push_back(WhyNoLock(errno));
  sched_param param{};
  param.sched_priority = request.priority;
  if (const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &param); error != 0)
    refused.push_back(WhyNoPriority(request.priority, error));
  PrefaultStack(request.stack_prefault_bytes);
  return refused;
}

}  // namespace contour
