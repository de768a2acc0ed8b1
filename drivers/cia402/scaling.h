#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/nearest_whole.h"

// The only home of raw units: counts and per mille of the rated torque.
namespace contour {

/// Nm to per mille of the rated torque (0x6071, 0x6077, 0x60B2, 0x6072: INT16) and back.
struct TorqueScale {
  double rated_Nm = 1.0;

  /// To the nearest whole per mille, saturated at INT16; 0 for NaN.
  [[nodiscard]] std::int16_t ToPerMille(double torque_Nm) const noexcept {
    const double per_mille = torque_Nm / rated_Nm * 1000.0;
    if (std::isnan(per_mille)) return 0;
    return static_cast<std::int16_t>(NearestWhole(std::clamp(per_mille, -32768.0, 32767.0)));
  }
  [[nodiscard]] double FromPerMille(std::int16_t per_mille) const noexcept {
    return per_mille * rated_Nm / 1000.0;
  }
};

/// Motor angle in rad to encoder counts (0x6064, 0x607A: INT32) and back.
struct PositionScale {
  double counts_per_rev = 1.0;

  [[nodiscard]] double ToRad(std::int64_t counts) const noexcept {
    return static_cast<double>(counts) * (2.0 * std::numbers::pi / counts_per_rev);
  }
  /// Nearest count, wrapped at INT32 as the drive's counter is; 0 for what is not a number of the drive's
  /// range.
  [[nodiscard]] std::int32_t ToCounts(double position_rad) const noexcept {
    const double counts = position_rad / (2.0 * std::numbers::pi) * counts_per_rev;
    if (!(std::abs(counts) < 9.0e15)) return 0;
    return static_cast<std::int32_t>(
        static_cast<std::uint32_t>(static_cast<std::uint64_t>(NearestWhole(counts))));
  }
};

/// Continues a counter over the wrap of INT32. The first value is taken as it is; a later one is the value
/// nearest to the one before, so that it never jumps by a whole wrap, not even when a drive is brought up
/// again. From half a range away both directions are as near, and no axis goes that far between two readings:
/// a value from beyond three eighths of it (between what the two highest bits are worth) is a wrong one, or
/// of a count that began anew. It does not wrap, and where the readings were before is remembered, so that
/// the right one that follows is back there.
class Unwrap {
 public:
  std::int64_t Update(std::int32_t raw) noexcept {
    if (!seeded_) {
      counts_ = before_ = raw;
      seeded_ = true;
      return counts_;
    }
    const std::int32_t step = Step(counts_, raw);
    if (Small(step)) {
      counts_ += step;
    } else {
      const std::int32_t back = Step(before_, raw);
      const std::int64_t there = Small(back) ? before_ + back : counts_ - Low(counts_) + raw;
      before_ = counts_;
      counts_ = there;
    }
    return counts_;
  }
  [[nodiscard]] std::int64_t counts() const noexcept { return counts_; }

 private:
  static constexpr std::int32_t kMost = std::int32_t{3} << 29;
  static std::int32_t Low(std::int64_t counts) noexcept {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::uint64_t>(counts)));
  }
  static std::int32_t Step(std::int64_t from, std::int32_t raw) noexcept {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(raw) - static_cast<std::uint32_t>(Low(from)));
  }
  static bool Small(std::int32_t step) noexcept { return step >= -kMost && step <= kMost; }

  std::int64_t counts_ = 0;
  std::int64_t before_ = 0;  ///< where the readings were before they were last elsewhere
  bool seeded_ = false;
};

}  // namespace contour
