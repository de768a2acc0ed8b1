#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "drivers/can/frame_bus.h"

namespace contour::faults {

/// What is done to the frames of one identifier on their way between the cycle and its bus.
struct Meddling {
  enum class What : std::uint8_t { kDrop, kDelay, kDouble, kFlip };
  What what = What::kDrop;
  std::uint16_t id = 0;  ///< the frames concerned
  int frames = -1;       ///< so many of them; -1: all
  int cycles = 1;        ///< kDelay: comes so many cycles later
  int byte = 0;          ///< kFlip: of the data
  int bit = 0;
};

/// A bus whose frames are lost, late, doubled or changed, as long as something is to be done to them.
class MeddlingBus final : public FrameBus {
 public:
  explicit MeddlingBus(FrameBus& inner) : inner_(inner) {}

  void Begin(const Meddling& meddling) { todo_.push_back(meddling); }
  /// Everything goes its way again; what was held back is lost.
  void End() {
    todo_.clear();
    held_.clear();
  }

  std::size_t Receive(std::int64_t now_ns, std::span<StampedFrame> frames) noexcept override;
  std::size_t Send(std::int64_t now_ns, std::span<const CanFrame> frames) noexcept override;
  [[nodiscard]] BusState State() const noexcept override { return inner_.State(); }

 private:
  struct Held {
    StampedFrame frame;
    int cycles = 0;
  };
  /// The next thing to do to a frame of this identifier; null: nothing.
  Meddling* Find(std::uint16_t id) noexcept;
  static void Flip(const Meddling& meddling, CanFrame& frame) noexcept;

  FrameBus& inner_;
  std::vector<Meddling> todo_;
  std::deque<Held> held_;
};

}  // namespace contour::faults
