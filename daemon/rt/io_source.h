#pragma once

#include <cstdint>

#include "core/cycle_input.h"

namespace contour {

/// Where the loop takes the auxiliary I/O from. Read() never blocks; freshness is judged at now_ns
/// (CLOCK_MONOTONIC).
class IoSource {
 public:
  virtual ~IoSource() = default;
  virtual IoInput Read(std::int64_t now_ns) noexcept = 0;
};

/// A machine without auxiliary I/O: nothing is asked, nothing is permitted by it or taken away.
class NoIo final : public IoSource {
 public:
  IoInput Read(std::int64_t) noexcept override { return {}; }
};

}  // namespace contour
