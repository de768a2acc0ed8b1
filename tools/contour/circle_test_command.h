#pragma once

#include "tools/contour/command.h"

namespace CLI {
class App;
}

namespace contour {

/// `contour circle-test`: what a circle that something else has measured tells of two axes.
void AddCircleTestCommand(CLI::App& app, Action& action);

}  // namespace contour
