#pragma once

#include "tools/contour/command.h"

namespace CLI {
class App;
}

namespace contour {

/// Adds `contour commission`.
void AddCommissionCommand(CLI::App& app, Action& action);

}  // namespace contour
