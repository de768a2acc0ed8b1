#include "config/mode_advice.h"

#include "drivers/cia402/mode_for.h"

namespace contour {
namespace {

// A drive's velocity loop takes differences of whole counts. Measured (docs/control.md): with 10000 counts
// per turn `full` is worse in csp on circles, with 131072 it is better.
constexpr double kCoarse_counts_per_rev = 65536.0;

}  // namespace

std::vector<std::string> ModeAdvice(const MachineConfig& machine) {
  std::vector<std::string> advice;
  if (machine.machine.controller != ControllerName::kFull) return advice;
  for (const auto& [name, axis] : machine.axes) {
    const double counts = axis.drive.encoder_counts_per_rev;
    if (ModeFor(machine.machine.controller, axis.drive) != DriveMode::kCsp ||
        counts >= kCoarse_counts_per_rev)
      continue;
    advice.push_back("axes." + name + ".drive.mode: csp with an encoder of " +
                     std::to_string(static_cast<long long>(counts)) +
                     " counts per turn; below 65536, cst draws better circles");
  }
  return advice;
}

}  // namespace contour
