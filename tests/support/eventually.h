#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace contour::test {

/// Waits until something is so; the limit only ends a test that has failed already.
inline bool Eventually(const std::function<bool()>& so) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!so()) {
    if (std::chrono::steady_clock::now() > limit) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace contour::test
