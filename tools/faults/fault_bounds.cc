#include "tools/faults/fault_bounds.h"

#include <algorithm>
#include <iterator>

#include "config/stopping.h"

namespace contour::faults {
namespace {

/// Until the machine file has a bound of its own for each fault: what it allows, and its quick stop after as
/// long as a following error needs to grow, at most this long.
constexpr double kLongestNotice_s = 3.0;

const AxisConfig& AxisOf(const MachineConfig& machine, std::size_t axis) {
  return std::next(machine.axes.begin(), static_cast<std::ptrdiff_t>(axis))->second;
}

}  // namespace

RunBound BoundOf(const MachineConfig& machine, const FaultCase& c) {
  const AxisConfig& axis = AxisOf(machine, c.axis);
  const StoppingAxis stopping = ToStoppingAxis(machine, axis);
  RunBound bound;
  bound.departure_m = 1e-3 * axis.limits.safe_travel_mm;
  const double notice_s =
      std::min(kLongestNotice_s, axis.limits.following_error_mm / std::max(c.feed_mm_s, 1e-6));
  bound.time_s = notice_s + SilentMaster(stopping, stopping.speed_m_s).time_s;
  return bound;
}

RunBound BoundOfOthers(const MachineConfig& machine, const FaultCase& c, std::size_t axis) {
  const AxisConfig& other = AxisOf(machine, axis);
  const StoppingAxis stopping = ToStoppingAxis(machine, other);
  RunBound bound = BoundOf(machine, c);
  bound.departure_m = 1e-3 * std::max(other.limits.safe_travel_mm, other.limits.following_error_mm);
  bound.time_s = std::max(bound.time_s, SilentMaster(stopping, stopping.speed_m_s).time_s);
  return bound;
}

}  // namespace contour::faults
