#pragma once

#include "tools/contour/command.h"

namespace contour {

/// `contour pause`, `contour resume`, `contour feed PERCENT` and `contour zero`.
void AddPaceCommands(CLI::App& app, Action& action);

}  // namespace contour
