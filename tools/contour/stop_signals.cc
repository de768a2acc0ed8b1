#include "tools/contour/stop_signals.h"

#include <csignal>

namespace contour {
namespace {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");
void OnSignal(int /*signal*/) { stop_requested.store(true); }

}  // namespace

void StopOnSignals() {
  std::signal(SIGINT, OnSignal);
  std::signal(SIGTERM, OnSignal);
  // A terminal that is gone is one, unless nohup says that it may be; nobody who reads on is none.
  if (std::signal(SIGHUP, OnSignal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

std::atomic<bool>& StopRequested() { return stop_requested; }

}  // namespace contour
