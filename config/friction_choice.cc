#include "config/friction_choice.h"

#include <algorithm>
#include <limits>

#include "config/loop_axis.h"
#include "core/two_inertia_loop.h"
#include "drivers/cia402/mode_for.h"

namespace contour {
namespace {

// Measured on machines with modes of 40 to 400 Hz (docs/laboratory/family.md). With torques from here the
// filter's disturbance, fed back at some 170 Hz, rings with a mode below 300 Hz. Where the drive closes the
// loop, 10 mm circles are worse from 106 Hz down, and equal or better from 141 Hz up.
constexpr double kLowestInTorqueMode_Hz = 300.0;
constexpr double kLowestInCascade_Hz = 125.0;

}  // namespace

FrictionKind ChooseFriction(const MachineConfig& machine) {
  double lowest_Hz = std::numeric_limits<double>::infinity();
  bool cascade = false, tuned = true;
  for (const auto& [name, axis] : machine.axes) {
    lowest_Hz = std::min(lowest_Hz, ModeFrequency_Hz(TwoInertiaAxisOf(axis)));
    tuned = tuned && axis.loop.has_value();
    cascade = cascade || ModeFor(ControllerName::kFull, axis.drive) == DriveMode::kCsp;
  }
  // In torque mode it needs its loops; what was never tuned for it goes on as it did.
  if (!cascade && !tuned) return FrictionKind::kSrukf;
  const double limit_Hz = cascade ? kLowestInCascade_Hz : kLowestInTorqueMode_Hz;
  return lowest_Hz < limit_Hz ? FrictionKind::kLinear : FrictionKind::kSrukf;
}

}  // namespace contour
