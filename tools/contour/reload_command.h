#pragma once

#include "tools/contour/command.h"

namespace CLI {
class App;
}

namespace contour {

/// `contour reload`
void AddReloadCommand(CLI::App& app, Action& action);

}  // namespace contour
