#pragma once

#include <optional>
#include <string>
#include <vector>

namespace contour {

/// What contourd is to begin anew with: a model, AXIS=YAML, or torque mode with these loops (none: the mode
/// of the machine file).
struct NewStart {
  std::optional<std::string> model;
  std::optional<std::vector<std::string>> torque_loops;
};

}  // namespace contour
