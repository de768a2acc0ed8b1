#include "drivers/can/error_frame.h"
#include "drivers/can/loopback_bus.h"

// A file of its own, so that a program that injects no frames has no such thing in it.
namespace contour {

void LoopbackBus::Inject(std::int64_t now_ns, const CanFrame& frame) noexcept {
  AdvanceTo(now_ns);
  if (!state_.up || mailboxes_.size() == mailbox_capacity_) return;
  mailboxes_.push_back({frame, now_ns_, kStranger});
}

void LoopbackBus::InjectErrorFrame(std::uint32_t id, std::span<const std::uint8_t, 8> data) noexcept {
  static_cast<void>(TakeErrorFrame(id, data, false, state_));
}

}  // namespace contour
