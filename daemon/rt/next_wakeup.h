#pragma once

#include <cstdint>

namespace contour {

/// A point of the period grid: origin + index * period.
struct GridPoint {
  std::uint64_t index = 0;
  std::int64_t time_ns = 0;
  std::uint32_t skipped = 0;  ///< grid points left out since the last one
};

/// The grid point to wake for after `last_index`, seen at `now_ns`. The grid never moves: a point that has
/// just gone by is still taken (late), one that lies a whole period back is skipped, so that the phase is
/// kept after a late cycle.
constexpr GridPoint NextWakeup(std::int64_t origin_ns, std::int64_t period_ns, std::uint64_t last_index,
                               std::int64_t now_ns) noexcept {
  std::uint64_t next = last_index + 1;
  const std::int64_t next_ns = origin_ns + static_cast<std::int64_t>(next) * period_ns;
  std::uint32_t skipped = 0;
  if (now_ns - next_ns >= period_ns) {
    skipped = static_cast<std::uint32_t>((now_ns - next_ns) / period_ns);
    next += skipped;
  }
  return {next, origin_ns + static_cast<std::int64_t>(next) * period_ns, skipped};
}

static_assert(NextWakeup(1000, 100, 0, 1050).time_ns == 1100, "on time: the next point");
static_assert(NextWakeup(1000, 100, 0, 1150).time_ns == 1100,
              "late by half a period: the point is taken late");
static_assert(NextWakeup(1000, 100, 0, 1150).skipped == 0);
static_assert(NextWakeup(1000, 100, 0, 1350).time_ns == 1300,
              "late by more: whole periods are skipped, the phase stays");
static_assert(NextWakeup(1000, 100, 0, 1350).skipped == 2);

}  // namespace contour
