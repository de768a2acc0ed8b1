#pragma once

#include <string>

namespace contour::diagnosis {

/// What the extended model is expected to do for the path, by simulation.
struct ContourGain {
  std::string program;
  double before_um = 0.0;  ///< largest contour error of the table with the model as stated
  double after_um = 0.0;   ///< and with the extended one

  [[nodiscard]] double gain() const { return before_um > 0.0 ? 1.0 - after_um / before_um : 0.0; }
};

}  // namespace contour::diagnosis
