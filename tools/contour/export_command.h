#pragma once

#include "tools/contour/command.h"

namespace CLI {
class App;
}

namespace contour {

/// `contour export LOG --out FILE.csv`
void AddExportCommand(CLI::App& app, Action& action);

}  // namespace contour
