#pragma once

#include "tools/contour/command.h"

namespace CLI {
class App;
}

namespace contour {

/// `contour run PROGRAM [--out DIR] [--truth FILE] [--controller NAME]`
void AddRunCommand(CLI::App& app, Action& action);

}  // namespace contour
