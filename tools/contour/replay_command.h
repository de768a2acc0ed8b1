#pragma once

#include "tools/contour/command.h"

namespace CLI {
class App;
}

namespace contour {

/// `contour replay LOG`
void AddReplayCommand(CLI::App& app, Action& action);

}  // namespace contour
