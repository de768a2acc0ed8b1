#pragma once

#include "tools/contour/command.h"

namespace CLI {
class App;
}

namespace contour {

/// `contour status [--json]`
void AddStatusCommand(CLI::App& app, Action& action);

/// `contour watch [--json] [--period MS]`
void AddWatchCommand(CLI::App& app, Action& action);

}  // namespace contour
