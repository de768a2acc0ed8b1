#pragma once

#include <CLI/CLI.hpp>

#include "tools/contour/command.h"

namespace contour {

/// `contour simulate`: the daemon's own cycle and the emulated machine in virtual time.
void AddSimulateCommand(CLI::App& app, Action& action);

}  // namespace contour
