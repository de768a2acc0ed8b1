#include "design/path_following.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>

#include "config/loop_axis.h"
#include "design/loop_margins.h"
#include "drivers/cia402/mode_for.h"

namespace contour {
namespace {

std::string Text(double following_mm) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", following_mm);
  return text.data();
}

bool RunsLoop(const MachineConfig& machine, const AxisConfig& axis) {
  return KnowsTwoInertias(machine.machine.controller, machine.control.friction) && axis.loop &&
         ModeFor(machine.machine.controller, axis.drive) == DriveMode::kCst;
}

}  // namespace

double ExpectedFollowing_m(const MachineConfig& machine, const AxisConfig& axis) {
  if (!RunsLoop(machine, axis)) return WindUpUnderForceStep_m(axis);
  const double period_s = 1e-6 * machine.machine.cycle_us;
  const bool by_scale = axis.scale_loop && axis.drive.linear_scale;
  const LoopAxis on = by_scale ? *ScaleLoopAxisOf(axis) : LoopAxisOf(axis);
  try {
    const TwoInertiaLoop loop =
        DesignLoop(on.axis, by_scale ? *axis.scale_loop : *axis.loop, period_s, by_scale);
    return UnderForceStep(SlidingMember(on), loop, period_s, on.limits.force_step * on.rated_force_N).mean_m;
  } catch (const std::invalid_argument&) {
    return WindUpUnderForceStep_m(axis);  // whoever makes the cycle says what is wrong with the loop
  }
}

double ExpectedFollowing_mm(const MachineConfig& machine) {
  double following_mm = 0.0;
  for (const auto& [name, axis] : machine.axes)
    following_mm = std::max(following_mm, 1e3 * ExpectedFollowing_m(machine, axis));
  return std::stod(Text(std::min(following_mm, kMostPathFollowing_mm)));
}

std::vector<std::string> PathFollowingIfMissing(const MachineConfig& machine) {
  if (machine.machine.path_following_mm) return {};
  return {"machine.path_following_mm=" + Text(ExpectedFollowing_mm(machine))};
}

std::optional<std::string> WiderToleranceText(const MachineConfig& machine) {
  if (machine.machine.path_tolerance_mm) return std::nullopt;
  const double following_mm = machine.machine.path_following_mm.value_or(ExpectedFollowing_mm(machine));
  const double tolerance_mm = PathTolerance_mm(machine, following_mm);
  if (tolerance_mm <= kUsualPathTolerance_mm) return std::nullopt;
  return "programs that state no tolerance are followed within " + Text(tolerance_mm) + " mm, not " +
         Text(kUsualPathTolerance_mm) + ": the table is expected to be off its path by " +
         Text(following_mm) + " mm. machine.path_tolerance_mm states another";
}

}  // namespace contour
