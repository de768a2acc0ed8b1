#pragma once

#include "tools/contour/command.h"

namespace CLI {
class App;
}

namespace contour {

/// `contour enable`, `disable`, `stop` and `reset`: each asks the daemon and waits until the machine has got
/// there.
void AddRequestCommands(CLI::App& app, Action& action);

}  // namespace contour
