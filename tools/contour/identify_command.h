#pragma once

#include "tools/contour/command.h"

namespace CLI {
class App;
}

namespace contour {

/// Adds `contour identify`.
void AddIdentifyCommand(CLI::App& app, Action& action);

}  // namespace contour
