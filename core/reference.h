#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

namespace contour {

/// Whether an axis knows where it is.
enum class ReferenceState : std::uint8_t {
  kAbsolute = 0,   ///< its encoder is absolute
  kNeverTold = 1,  ///< its encoder counts from where it stood at power-up, and nobody has said where that was
  kTold = 2,       ///< it has been told, and has counted without a break since
  kLost = 3,       ///< it knew, or moved, and then its count began anew or cannot be believed
};

constexpr std::string_view Name(ReferenceState s) noexcept {
  switch (s) {
    case ReferenceState::kAbsolute:
      return "absolute";
    case ReferenceState::kNeverTold:
      return "never_told";
    case ReferenceState::kTold:
      return "told";
    case ReferenceState::kLost:
      return "lost";
  }
  return "unknown";
}

constexpr bool IsReferenced(ReferenceState s) noexcept {
  return s == ReferenceState::kAbsolute || s == ReferenceState::kTold;
}

/// What a request of kind kReference says: the position where the axis stands now. It travels in the 32 bits
/// of Request::program_id, and so is in the log as every request is.
struct ReferenceRequest {
  std::uint8_t axis = 0;
  double position_m = 0.0;
};

namespace reference_request {
inline constexpr double kStep_m = 1e-7;  ///< positions that people tell are no finer
inline constexpr int kPositionBits = 29;
inline constexpr std::int32_t kMost = (1 << (kPositionBits - 1)) - 1;  ///< steps, either sign: 26 m
}  // namespace reference_request

/// Nothing when the position is no number or too far away, or there can be no such axis.
constexpr std::optional<std::uint32_t> Encode(const ReferenceRequest& r) noexcept {
  using reference_request::kMost, reference_request::kPositionBits, reference_request::kStep_m;
  const double steps = r.position_m / kStep_m;
  if (r.axis > 7 || !(steps >= -kMost && steps <= kMost)) return std::nullopt;
  const auto whole = static_cast<std::int32_t>(steps < 0.0 ? steps - 0.5 : steps + 0.5);
  const std::uint32_t low = static_cast<std::uint32_t>(whole) & ((1u << kPositionBits) - 1u);
  return static_cast<std::uint32_t>(r.axis) << kPositionBits | low;
}

constexpr ReferenceRequest DecodeReference(std::uint32_t code) noexcept {
  using reference_request::kPositionBits, reference_request::kStep_m;
  // The sign is that of the position's highest bit.
  const auto whole = static_cast<std::int32_t>(code << (32 - kPositionBits)) >> (32 - kPositionBits);
  return {static_cast<std::uint8_t>(code >> kPositionBits), whole * kStep_m};
}

}  // namespace contour
