#pragma once

#include <string>

#include "core/states.h"
#include "tools/machine/load_emulated_machine.h"

namespace contour::faults {

/// The machine of a file as contourd would run it with all its drives in that mode: the friction law and the
/// loops that the file leaves open are those of the mode. A file that does not allow the mode is refused.
EmulatedMachineFile MachineInMode(const std::string& path, const EmulatedMachineFile& as_stated,
                                  DriveMode mode);

}  // namespace contour::faults
