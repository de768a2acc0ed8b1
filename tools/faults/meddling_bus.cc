#include "tools/faults/meddling_bus.h"

#include <algorithm>
#include <array>

namespace contour::faults {

Meddling* MeddlingBus::Find(std::uint16_t id) noexcept {
  for (Meddling& m : todo_) {
    if (m.id != id || m.frames == 0) continue;
    if (m.frames > 0) --m.frames;
    return &m;
  }
  return nullptr;
}

void MeddlingBus::Flip(const Meddling& meddling, CanFrame& frame) noexcept {
  frame.data[static_cast<std::size_t>(meddling.byte)] ^= static_cast<std::uint8_t>(1U << meddling.bit);
}

// One call is one cycle. Frames are only taken from the bus for which there is room, doubled or held back
// ones included.
std::size_t MeddlingBus::Receive(std::int64_t now_ns, std::span<StampedFrame> frames) noexcept {
  std::size_t count = 0;
  for (Held& h : held_) --h.cycles;
  while (!held_.empty() && held_.front().cycles <= 0 && count < frames.size()) {
    frames[count] = held_.front().frame;
    frames[count++].stamp_ns = now_ns;
    held_.pop_front();
  }
  std::array<StampedFrame, 256> arrived;
  const std::size_t got =
      inner_.Receive(now_ns, {arrived.data(), std::min(arrived.size(), frames.size() - count)});
  for (std::size_t i = 0; i < got; ++i) {
    StampedFrame f = arrived[i];
    const Meddling* m = Find(f.frame.id);
    if (m != nullptr && m->what == Meddling::What::kDrop) continue;
    if (m != nullptr && m->what == Meddling::What::kDelay) {
      held_.push_back({f, m->cycles});
      continue;
    }
    if (m != nullptr && m->what == Meddling::What::kFlip) Flip(*m, f.frame);
    if (count < frames.size()) frames[count++] = f;
    if (m != nullptr && m->what == Meddling::What::kDouble && count < frames.size()) frames[count++] = f;
  }
  return count;
}

// What is lost on the way has been accepted all the same. Set-points are not delayed: the cycle would not
// know the difference from lost ones.
std::size_t MeddlingBus::Send(std::int64_t now_ns, std::span<const CanFrame> frames) noexcept {
  std::size_t accepted = 0;
  for (const CanFrame& frame : frames) {
    CanFrame f = frame;
    const Meddling* m = Find(f.id);
    if (m != nullptr && (m->what == Meddling::What::kDrop || m->what == Meddling::What::kDelay)) {
      ++accepted;
      continue;
    }
    if (m != nullptr && m->what == Meddling::What::kFlip) Flip(*m, f);
    accepted += inner_.Send(now_ns, {&f, 1});
    if (m != nullptr && m->what == Meddling::What::kDouble) inner_.Send(now_ns, {&f, 1});
  }
  return accepted;
}

}  // namespace contour::faults
