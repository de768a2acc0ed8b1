#pragma once

#include <CLI/CLI.hpp>

#include "tools/contour/command.h"

namespace contour {

/// `contour emps --emps DIR --out DIR`
void AddEmpsCommand(CLI::App& app, Action& action);

}  // namespace contour
