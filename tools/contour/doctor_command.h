#pragma once

#include "tools/contour/command.h"

namespace CLI {
class App;
}

namespace contour {

/// `contour doctor`
void AddDoctorCommand(CLI::App& app, Action& action);

}  // namespace contour
