#pragma once

#include "tools/contour/command.h"

namespace CLI {
class App;
}

namespace contour {

/// `contour emulate --config FILE [--bus vcan0,...] [--clock sync|wall] [--truth FILE] [--seed N] [--set
/// KEY=VALUE]...`
void AddEmulateCommand(CLI::App& app, Action& action);

}  // namespace contour
