#pragma once

#include <array>
#include <bitset>
#include <cstdint>

#include "core/axis.h"

namespace contour {

/// Which SYNC a drive's answers belong to, before anything moves. An answer that comes right behind the only
/// SYNC so far is the answer to it. Where the first one comes later, either that drive began to answer later,
/// or all of its answers come a cycle or more late and have the look of answers to the next SYNC. Then one
/// SYNC is left out: a drive in time misses its answer at the next grid point, one that is late at a later
/// one. Held up once is not late: every try has to say so, and one to the contrary is enough.
class AnswerProbe {
 public:
  static constexpr std::uint8_t kTries = 4;
  /// Undisturbed SYNCs before the first try: what was held up until then has come. One more before each of
  /// the others, so that what comes late every so many cycles is not met by all of them.
  static constexpr std::uint8_t kApart_cycles = 8;
  using Axes = std::bitset<kMaxAxes>;

  void Reset() noexcept { *this = {}; }
  void Doubt(std::size_t axis) noexcept {
    doubted_[axis] = true;
    tries_[axis] = late_[axis] = 0;
  }
  [[nodiscard]] bool running() const noexcept { return doubted_.any(); }
  /// In the next cycle no SYNC is sent.
  [[nodiscard]] bool leaves_out() const noexcept { return leaves_out_; }

  /// At the end of each cycle while it runs, with the axes that answered in it. Gives those that are late for
  /// certain.
  Axes Step(const Axes& answered, std::uint64_t elapsed_cycles) noexcept {
    if (!running()) return {};
    ++step_;
    leaves_out_ = step_ == apart();
    // The cycle without SYNC is the next one, and what came in it answers the SYNC before.
    if (step_ <= apart() + 1) return {};
    const bool first_look = step_ == apart() + 2;
    // Over a grid point without a look it is not known when an answer came.
    whole_ = (whole_ || first_look) && elapsed_cycles == 1;
    if (first_look) {
      at_once_ = answered;
      return {};
    }
    step_ = 0;
    round_ = round_ + 1U < kTries ? static_cast<std::uint8_t>(round_ + 1U) : std::uint8_t{0};
    return Judge(answered);
  }

 private:
  [[nodiscard]] int apart() const noexcept { return kApart_cycles + round_; }
  Axes Judge(const Axes& answered) noexcept {
    Axes late;
    for (std::size_t i = 0; i < kMaxAxes; ++i) {
      if (!doubted_[i]) continue;
      ++tries_[i];
      if (whole_ && at_once_[i]) ++late_[i];
      late[i] = late_[i] == kTries;
      const bool in_time = whole_ && !at_once_[i] && answered[i];
      if (in_time || tries_[i] == kTries) doubted_[i] = false;
    }
    return late;
  }

  Axes doubted_;
  Axes at_once_;  ///< answered at the grid point after the SYNC that was left out
  std::array<std::uint8_t, kMaxAxes> tries_{};
  std::array<std::uint8_t, kMaxAxes> late_{};  ///< of these, that said so
  std::uint8_t step_ = 0;
  std::uint8_t round_ = 0;
  bool leaves_out_ = false;
  bool whole_ = false;  ///< no grid point was skipped during this try
};

}  // namespace contour
