#pragma once

#include "tools/contour/command.h"

namespace CLI {
class App;
}

namespace contour {

/// `contour contest`: every controller on every program and machine.
void AddContestCommand(CLI::App& app, Action& action);

}  // namespace contour
