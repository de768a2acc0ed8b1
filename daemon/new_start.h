#pragma once

#include <optional>
#include <string>
#include <vector>

namespace contour {

/// A mode to commission in, whatever the machine file says. Torque mode: loops of all axes and the models
/// that they were found for, where those are not the axes' own; AXIS=YAML. Or csp: the names of all axes.
/// With neither, the mode of the machine file.
struct RecordingMode {
  std::vector<std::string> loops, models;
  std::vector<std::string> csp_axes{};
};

/// What contourd is to begin anew with: a model, AXIS=YAML, or another mode.
struct NewStart {
  std::optional<std::string> model;
  std::optional<RecordingMode> recording_mode;
};

}  // namespace contour
