// Loaded into QEMU (LD_PRELOAD) so that the guest's time depends on nothing of the host.
//
// With icount, time moves in two threads. The processor's thread counts instructions; while the processor is
// halted, QEMU's main loop moves the clock on to the next timer (icount_start_warp_timer). But the main loop
// also wakes for every timer that ends while the processor runs, and looks then, at a moment that the host's
// scheduler chooses, whether the processor is halted. When that moment falls between the halt and the
// processor's thread having added up what it ran, the clock is set forward from an instant that is too early
// by those instructions: the next timer comes late by them, and nothing is as in any other run from there on.
// (It happened within a minute of a 1 kHz loop, in ten seconds of six at 5 kHz.)
//
// So the two take turns: what wakes the main loop waits until the processor's thread waits. Nothing of QEMU
// is changed but the moment at which its main loop comes out of ppoll.
#include <dlfcn.h>
#include <poll.h>
#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <string_view>

namespace {

template <class Function>
Function* Next(const char* name, const char* version) {
  void* found = dlvsym(RTLD_NEXT, name, version);  // without it there may be an older one, of another layout
  if (found == nullptr) found = dlsym(RTLD_NEXT, name);
  if (found == nullptr) std::abort();
  return reinterpret_cast<Function*>(found);
}

/// The condition on which the processor's thread waits; null while it runs, or is about to.
std::atomic<pthread_cond_t*> g_waits_for{nullptr};
/// QEMU's big lock; null before the processor's thread first waits: until then there is nothing to take turns
/// with.
std::atomic<pthread_mutex_t*> g_lock{nullptr};

/// The main loop polls without the lock. Whoever polls with it cleans up behind a guest that has ended.
bool IsMainLoop() {
  thread_local const auto self = static_cast<pid_t>(syscall(SYS_gettid));
  const pthread_mutex_t* lock = g_lock.load();
  return self == getpid() && lock != nullptr && lock->__data.__owner != self;
}

/// By its name, as -name debug-threads=on gives it.
bool IsProcessorsThread() {
  thread_local const bool is_processors = [] {
    std::array<char, 16> name{};
    pthread_getname_np(pthread_self(), name.data(), name.size());
    return std::string_view(name.data()).ends_with("/TCG");
  }();
  return is_processors;
}

}  // namespace

extern "C" {

int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex) {
  static const auto next = Next<decltype(pthread_cond_wait)>("pthread_cond_wait", "GLIBC_2.3.2");
  if (!IsProcessorsThread()) return next(condition, mutex);
  g_lock.store(mutex);
  g_waits_for.store(condition);
  g_waits_for.notify_all();
  const int result = next(condition, mutex);
  g_waits_for.store(nullptr);
  return result;
}

// The one who wakes the processor's thread does not wait for it to notice.
int pthread_cond_broadcast(pthread_cond_t* condition) {
  static const auto next = Next<decltype(pthread_cond_broadcast)>("pthread_cond_broadcast", "GLIBC_2.3.2");
  pthread_cond_t* waiting = condition;
  g_waits_for.compare_exchange_strong(waiting, nullptr);
  return next(condition);
}

int ppoll(pollfd* fds, nfds_t count, const timespec* timeout, const sigset_t* mask) {
  static const auto next = Next<decltype(ppoll)>("ppoll", "GLIBC_2.4");
  const int result = next(fds, count, timeout, mask);
  const int error = errno;
  if (IsMainLoop()) g_waits_for.wait(nullptr);
  errno = error;
  return result;
}
}
