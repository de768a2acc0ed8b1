#pragma once

#include <string>
#include <vector>

#include "config/machine_config.h"
#include "daemon/program/gcode/program_halts.h"

namespace contour {

/// Is there an output for what a program asks for?
bool Listens(const ProgramOutputsConfig& outputs, const GcodeEvent& event);

/// Why an output cannot do what a program asks for; empty: it can.
std::string Problem(const ProgramOutputsConfig& outputs, const GcodeEvent& event);

/// The words that switch something on a machine: M3, S ...
std::vector<std::string> WordsOf(const MachineConfig& machine);

/// What a machine does about a program's events.
EventUse UseOfEvents(const MachineConfig& machine, bool optional_stop);

}  // namespace contour
