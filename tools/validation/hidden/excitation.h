#pragma once

#include <string>

#include "tools/plant_emulator/random.h"
#include "tools/validation/hidden/hidden_case.h"

namespace contour::hidden {

/// A program that excites every kind (the column "excitation needed"): rest, torque steps, reversals of six
/// amplitudes, creep, full strokes at several speeds at the beginning, in the middle and at the end, torque
/// above 100 Hz while sliding, pulses, warm-up and cool-down; with a second axis, moves of its own. Speeds,
/// amplitudes and order are drawn. The short one has most of it once, and neither slow full strokes nor a
/// cool-down.
std::string ExcitationProgram(plant::Random& random, const Setting& setting);

}  // namespace contour::hidden
