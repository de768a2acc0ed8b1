#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace contour {

/// Ends the process when its end takes too long, whatever is stuck: a disk, a server, a request. For the time
/// after the axes have stopped, when nothing is left that must not be broken off.
class LastResort {
 public:
  LastResort(std::chrono::seconds limit, int exit_status);
  ~LastResort();
  LastResort(const LastResort&) = delete;
  LastResort& operator=(const LastResort&) = delete;

  /// What is waited for from now on. The text must stay.
  void Now(const char* what);

  /// Says what is not waited for, and ends the process without it.
  [[noreturn]] static void End(const char* what, int exit_status);

 private:
  void Watch(std::chrono::seconds limit, int exit_status);

  std::mutex mutex_;  // guards those below
  std::condition_variable wake_;
  bool ended_ = false;
  const char* what_ = "";
  std::thread thread_;
};

}  // namespace contour
