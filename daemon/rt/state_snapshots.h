#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/rt/cycle.h"
#include "daemon/rt/spsc_ring.h"

namespace contour {

/// Copies of the cycle's state, taken by the loop between two cycles and handed to whoever keeps the last
/// seconds for a replay. When nobody takes them away, none are made.
class StateSnapshots {
 public:
  struct Snapshot {
    std::uint64_t cycle = 0;  ///< the last one that the state has taken in
    std::vector<std::byte> bytes;
  };

  /// All memory there will be.
  StateSnapshots(std::size_t state_bytes, std::uint64_t every_cycles)
      : ring_(kSlots), every_cycles_(every_cycles) {
    for (std::size_t i = 0; i < ring_.capacity(); ++i) {
      ring_.Reserve()->bytes.resize(state_bytes);
      ring_.Publish();
    }
    while (ring_.Front() != nullptr) ring_.Release();
  }

  /// Real-time side, after the frames of `cycle` have been sent.
  void TakeWhenDue(Cycle& state, std::uint64_t cycle) noexcept {
    if (cycle < due_) return;
    Snapshot* slot = ring_.Reserve();
    if (slot == nullptr) return;
    slot->cycle = cycle;
    state.SaveState(slot->bytes);
    ring_.Publish();
    due_ = cycle + every_cycles_;
  }

  /// The other side: the oldest one not taken yet, or null.
  [[nodiscard]] const Snapshot* Front() noexcept { return ring_.Front(); }
  void Release() noexcept { ring_.Release(); }

 private:
  static constexpr std::size_t kSlots = 2;
  SpscRing<Snapshot> ring_;
  std::uint64_t every_cycles_;
  std::uint64_t due_ = 0;
};

}  // namespace contour
