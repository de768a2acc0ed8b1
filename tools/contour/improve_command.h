#pragma once

#include "tools/contour/command.h"

namespace CLI {
class App;
}

namespace contour {

/// Adds `contour improve`.
void AddImproveCommand(CLI::App& app, Action& action);

}  // namespace contour
