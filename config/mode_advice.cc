#include "config/mode_advice.h"

#include <cmath>

#include "config/circle_errors.h"
#include "config/friction_choice.h"
#include "config/number_text.h"
#include "drivers/cia402/mode_for.h"

namespace contour {
namespace {

// One digit or two: it is a rule of thumb.
std::string Micrometres(double error_m) {
  const double step_um = std::pow(10.0, std::floor(std::log10(1e6 * error_m)) - 1.0);
  return RoundedText(step_um * std::round(1e6 * error_m / step_um)) + " um";
}

}  // namespace

std::vector<std::string> ModeAdvice(const MachineConfig& machine) {
  std::vector<std::string> advice;
  if (machine.machine.controller != ControllerName::kFull) return advice;
  const double period_s = 1e-6 * machine.machine.cycle_us;
  for (const auto& [name, axis] : machine.axes) {
    if (ModeFor(machine.machine.controller, axis.drive) != DriveMode::kCsp) continue;
    // The filter goes by every report.
    const bool averaged =
        machine.control.friction == FrictionKind::kLinear && ReportsAreNoise(axis, period_s);
    const double here_m = CircleErrorByDrive_m(axis, averaged), there_m = UsualCircleErrorByTorque_m(axis);
    if (here_m <= kModesDiffer * there_m) continue;
    std::string text = "axes." + name + ".drive.mode: csp with an encoder of " +
                       std::to_string(static_cast<long long>(axis.drive.encoder_counts_per_rev)) +
                       " counts per turn, whose steps the drive answers: circles off by some " +
                       Micrometres(here_m) + " are expected, in cst by " + Micrometres(there_m);
    if (const double alone_m = CircleErrorByDriveAlone_m(axis); here_m > kModesDiffer * alone_m)
      text += ", and with the drive's own loop alone (machine.controller: csp) by " + Micrometres(alone_m);
    advice.push_back(text);
  }
  return advice;
}

std::optional<std::string> AdviceForDrive(const std::string& axis_name, const AxisConfig& axis,
                                          double compliance_m_N, double period_s) {
  const double here_m = CircleErrorByTorque_m(axis, compliance_m_N);
  const double there_m = CircleErrorByDrive_m(axis, ReportsAreNoise(axis, period_s));
  if (here_m <= kModesDiffer * there_m) return std::nullopt;
  return "axes." + axis_name + ".drive.mode: csp is expected to draw better circles, off by some " +
         Micrometres(there_m) + " instead of " + Micrometres(here_m) +
         ": the drive's own loop is stiffer than one over the bus, where it keeps its margins with this "
         "table (contour commission --axis " +
         axis_name + " --drive measures it)";
}

}  // namespace contour
