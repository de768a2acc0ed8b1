#include "tools/contour/ends_at_once.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstring>
#include <iostream>

#include "core/exit_status.h"

namespace contour {
namespace {

std::atomic<const char*> words{""};
static_assert(std::atomic<const char*>::is_always_lock_free, "read by a signal handler");

// Other threads compute on: nothing but what POSIX allows here, and no destructor.
void End(int /*signal*/) {
  const char* text = words.load();
  if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) ::_exit(kExitFailed);
  ::_exit(kExitFailed);
}

}  // namespace

EndsAtOnce::EndsAtOnce(const char* saying) {
  std::cout << std::flush;
  words = saying;
  interrupt_ = std::signal(SIGINT, End);
  terminate_ = std::signal(SIGTERM, End);
}

EndsAtOnce::~EndsAtOnce() {
  std::signal(SIGINT, interrupt_);
  std::signal(SIGTERM, terminate_);
}

}  // namespace contour
