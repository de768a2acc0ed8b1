#include "drivers/can/loopback_bus.h"

// A file of its own, so that a program that never takes the link down has no such thing in it.
namespace contour {

void LoopbackBus::SetLink(std::int64_t now_ns, bool up) noexcept {
  AdvanceTo(now_ns);
  state_.up = up;
  if (up) return;
  mailboxes_.clear();
  send_count_ = 0;
  busy_ = false;
  idle_from_ns_ = now_ns_;
}

}  // namespace contour
