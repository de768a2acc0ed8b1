#include "daemon/service_notifier.h"

#include <systemd/sd-daemon.h>

namespace contour {

ServiceNotifier::ServiceNotifier() {
  std::uint64_t period_us = 0;
  if (sd_watchdog_enabled(0, &period_us) > 0) watchdog_ = std::chrono::microseconds(period_us);
}

void ServiceNotifier::StillStarting() { sd_notify(0, "EXTEND_TIMEOUT_USEC=30000000"); }

void ServiceNotifier::Ready() {
  if (ready_) return;
  ready_ = true;
  sd_notify(0, "READY=1");
}

void ServiceNotifier::Stopping() { sd_notify(0, "STOPPING=1"); }

void ServiceNotifier::Status(const std::string& text) {
  if (text == status_) return;
  status_ = text;
  sd_notify(0, ("STATUS=" + text).c_str());
}

void ServiceNotifier::Alive(std::uint64_t cycles) {
  if (watchdog_.count() == 0 || cycles == cycles_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - fed_ < watchdog_ / 2) return;
  fed_ = now;
  cycles_ = cycles;
  sd_notify(0, "WATCHDOG=1");
}

}  // namespace contour
