#pragma once

#include <CLI/CLI.hpp>

#include "tools/contour/command.h"

namespace contour {

/// `contour diagnose LOG... --model FILE`
void AddDiagnoseCommand(CLI::App& app, Action& action);

}  // namespace contour
