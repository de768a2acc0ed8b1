#pragma once

#include "tools/contour/command.h"

namespace CLI {
class App;
}

namespace contour {

/// `contour tune`: the same search, cost and budget for every controller.
void AddTuneCommand(CLI::App& app, Action& action);

}  // namespace contour
