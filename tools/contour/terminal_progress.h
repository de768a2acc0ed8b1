#pragma once

#include <unistd.h>

#include <iostream>
#include <string_view>

namespace contour {

/// One line that renews itself on a terminal, nothing in a pipe.
class TerminalProgress {
 public:
  TerminalProgress() = default;
  TerminalProgress(const TerminalProgress&) = delete;
  TerminalProgress& operator=(const TerminalProgress&) = delete;
  ~TerminalProgress() {
    if (shown_) std::cerr << "\r\x1b[K" << std::flush;
  }

  void Show(std::string_view doing, double share) {
    if (!terminal_) return;
    std::cerr << "\r\x1b[K" << doing << " " << static_cast<int>(100.0 * share) << " %" << std::flush;
    shown_ = true;
  }

 private:
  bool terminal_ = ::isatty(STDERR_FILENO) != 0;
  bool shown_ = false;
};

}  // namespace contour
