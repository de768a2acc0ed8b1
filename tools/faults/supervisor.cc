#include "tools/faults/supervisor.h"

#include <limits>

namespace contour::faults {
namespace {

constexpr double kNever = std::numeric_limits<double>::max();

void NoFollowingError(CycleConfig& c) {
  for (CycleAxisConfig& a : c.axes) a.limits.following_error_mm = kNever;
}

void NoStaleness(CycleConfig& c) { c.control.guard.stale_cycles = std::numeric_limits<std::int32_t>::max(); }

}  // namespace

const std::vector<Supervisor>& Supervisors() {
  static const std::vector<Supervisor> all{
      {"following_error", "the guard's distance to the path", NoFollowingError},
      {"stale_feedback", "the guard's count of cycles without feedback", NoStaleness},
  };
  return all;
}

const Supervisor* FindSupervisor(std::string_view name) {
  for (const Supervisor& s : Supervisors())
    if (s.name == name) return &s;
  return nullptr;
}

}  // namespace contour::faults
