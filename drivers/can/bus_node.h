#pragma once

#include <cstdint>
#include <limits>

#include "core/can_frame.h"
#include "core/fixed_vector.h"

namespace contour {

/// A frame that a node wants to send, not before ready_ns.
struct PendingFrame {
  CanFrame frame;
  std::int64_t ready_ns = 0;
};
using PendingFrames = FixedVector<PendingFrame, 32>;

inline constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

/// A participant on an in-process bus (the emulated drives). Time is handed in; nothing here reads a clock.
class BusNode {
 public:
  virtual ~BusNode() = default;

  /// A frame whose last bit was on the wire at `time_ns`. Replies go into `out`.
  virtual void OnFrame(const CanFrame& frame, std::int64_t time_ns, PendingFrames& out) noexcept = 0;

  /// Called when time reaches NextTimer(): heartbeats, watchdogs.
  virtual void OnTimer(std::int64_t time_ns, PendingFrames& out) noexcept = 0;

  /// When OnTimer wants to be called next; kNever for not at all.
  [[nodiscard]] virtual std::int64_t NextTimer() const noexcept = 0;
};

}  // namespace contour
