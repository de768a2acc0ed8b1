#pragma once

#include <string>

#include "tools/machine/load_emulated_machine.h"

namespace contour {

/// Largest contour error at the table of a program of config/programs after its first turn, um; NaN where the
/// machine stopped or has no loop to run with. `scratch` is a directory for the run's files.
double Peak_um(const EmulatedMachineFile& file, const std::string& program, const std::string& scratch);

/// The machine with the loops that its models now have (axes.<name>.loop). Throws std::runtime_error where an
/// axis has none.
EmulatedMachineFile WithFoundLoops(EmulatedMachineFile file);

}  // namespace contour
