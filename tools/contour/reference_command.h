#pragma once

#include "tools/contour/command.h"

namespace CLI {
class App;
}

namespace contour {

/// `contour reference AXIS=MM...`: tells axes without an absolute encoder where they stand.
void AddReferenceCommand(CLI::App& app, Action& action);

}  // namespace contour
