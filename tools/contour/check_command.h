#pragma once

#include "tools/contour/command.h"

namespace CLI {
class App;
}

namespace contour {

/// `contour check FILE [--describe] [--set KEY=VALUE]...`
void AddCheckCommand(CLI::App& app, Action& action);

}  // namespace contour
