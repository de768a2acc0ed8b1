#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace contour {

/// Tells systemd how the service is: READY once, STATUS when it changes, WATCHDOG only while cycles advance.
/// Does nothing when there is no systemd.
class ServiceNotifier {
 public:
  ServiceNotifier();

  /// Before READY: to be given half a minute from now, should less be left.
  static void StillStarting();
  void Ready();
  void Stopping();
  void Status(const std::string& text);
  /// To be called often; feeds the watchdog at half its period while `cycles` grows.
  void Alive(std::uint64_t cycles);

 private:
  bool ready_ = false;
  std::string status_;
  std::chrono::microseconds watchdog_{0};
  std::chrono::steady_clock::time_point fed_{};
  std::uint64_t cycles_ = 0;
};

}  // namespace contour
