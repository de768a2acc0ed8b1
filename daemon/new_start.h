#pragma once

#include <optional>
#include <string>
#include <vector>

namespace contour {

/// Torque mode, whatever the machine file says: loops of all axes and the models that they were found for,
/// where those are not the axes' own; AXIS=YAML. Without loops, the mode of the machine file.
struct TorqueMode {
  std::vector<std::string> loops, models;
};

/// What contourd is to begin anew with: a model, AXIS=YAML, or another mode.
struct NewStart {
  std::optional<std::string> model;
  std::optional<TorqueMode> torque_mode;
};

}  // namespace contour
