#pragma once

#include <string>

#include "tools/validation/hidden/hidden_case.h"

namespace contour::hidden {

/// Stroke of the emulated axis: ten millimetres beyond the program's travel at either end.
inline double EmulatedStroke_mm(const TrueAxis& axis) { return 2.0 * axis.half_stroke_mm + 20.0; }

/// Of the axis; at it a nonlinear viscous torque has its stated size.
inline constexpr double kSpeedLimit_mm_s = 250.0;

/// The machine file: what the daemon runs with, and what the emulated machine is but for its effects.
std::string MachineText(const Setting& setting);

/// The model as the user states it to diagnosis.
std::string ModelText(const Setting& setting);

}  // namespace contour::hidden
