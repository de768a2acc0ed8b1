#pragma once

#include <array>

#include "core/reason.h"
#include "tools/faults/fault.h"
#include "tools/faults/phase.h"

namespace contour::faults {

enum class Outcome : std::uint8_t {
  kGoesOn,   ///< nothing may stop because of it
  kMayStop,  ///< a stop is as good as going on, when the departure is within its bound
  kStops,
};

/// One row: what has to come of a fault while the axes are held.
struct Expectation {
  Fault fault;
  Outcome at_rest;
  Outcome moving;
  std::array<Reason, 2> reasons{};  ///< of the stop; at most two
  Reason warning = Reason::kNone;   ///< must be seen in motion
};

/// The row of a fault. Fixed before the runs: a run that gives another reason has failed, the row is not
/// made to fit.
const Expectation& ExpectationOf(Fault fault) noexcept;

/// What has to come of it in a phase. Without torque nothing has to stop, and bring-up or enabling may also
/// fail by the reason that is their own.
struct ExpectedHere {
  Outcome outcome = Outcome::kMayStop;
  std::array<Reason, 2> reasons{};
  Reason of_phase = Reason::kNone;
  /// A linear scale contradicts an encoder that lies; it may be the first to.
  bool by_scale = false;
  [[nodiscard]] bool Allows(Reason reason) const noexcept {
    if (by_scale && (reason == Reason::kScaleDisagrees || reason == Reason::kScaleDoubted)) return true;
    return reason != Reason::kNone && (reason == reasons[0] || reason == reasons[1] || reason == of_phase);
  }
};

/// The encoder says what is not so.
[[nodiscard]] constexpr bool EncoderLies(Fault fault) noexcept {
  return fault == Fault::kEncoderReversed || fault == Fault::kEncoderJump ||
         fault == Fault::kEncoderJumpLarge || fault == Fault::kEncoderFrozen ||
         fault == Fault::kEncoderFlickers;
}
/// `crawls`: so slow that an axis without torque and an encoder that stands look the same, without a scale.
ExpectedHere ExpectedIn(Fault fault, Phase phase, bool crawls = false) noexcept;

}  // namespace contour::faults
