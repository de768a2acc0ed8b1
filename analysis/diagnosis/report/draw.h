#pragma once

#include <string>
#include <vector>

namespace contour::diagnosis {

/// Runs a script of tools/plots. Throws EnvironmentError, with what is needed, when it fails.
void Draw(const std::string& script, std::vector<std::string> arguments);

}  // namespace contour::diagnosis
