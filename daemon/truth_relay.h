#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/rt/spsc_ring.h"
#include "tools/plant_emulator/truth_writer.h"

namespace contour {

/// Carries truth rows of an in-process emulated machine out of the real-time thread to a file, which a thread
/// of its own writes. Rows that find no room are counted.
class TruthRelay final : public TruthSink {
 public:
  TruthRelay(const std::string& file, std::vector<std::string> axis_names)
      : ring_(kCapacity), writer_(file, std::move(axis_names)) {}

  void OnTruth(const TruthRow& row) noexcept override {
    if (!ring_.Push(row)) lost_.fetch_add(1, std::memory_order_relaxed);
  }
  /// The far side.
  void Drain() {
    bool any = false;
    while (TruthRow* row = ring_.Front()) {
      writer_.OnTruth(*row);
      ring_.Release();
      any = true;
    }
    if (any) writer_.Flush();
  }
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }
  /// An errno, once the file takes no more; 0 before.
  [[nodiscard]] int error() const noexcept { return writer_.error(); }

 private:
  static constexpr std::size_t kCapacity = 2048;
  SpscRing<TruthRow> ring_;
  TruthWriter writer_;
  std::atomic<std::uint64_t> lost_{0};
};

}  // namespace contour
