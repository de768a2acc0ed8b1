#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "tools/validation/family/family_run.h"

namespace contour {

/// A force on the table, across the path, that steps through a lag of 4 ms while the 10 mm circle is drawn.
struct ForceStepSpec {
  double share = 0.1;      ///< of the rated force
  double phase_deg = 0.0;  ///< of the third turn, counterclockwise from +X
};

struct ForceStepResult {
  double force_N = 0.0;
  double floor_um = 0.0;     ///< force over stiffness
  double peak_um = 0.0;      ///< what the force moves the table across the path, in 200 ms after it
  double rms_um = 0.0;       ///< from 10 to 200 ms after it
  double path_rms_um = 0.0;  ///< there, of the whole error of the path
  std::string failure{};
};

/// Twice the same run, without and with the force; the cell's program is not looked at.
ForceStepResult RunForceStep(const std::string& folder, const FamilyCell& cell, const ForceStepSpec& spec);

void WriteForceSteps(std::ostream& out, const std::vector<FamilyCell>& cells,
                     const std::vector<ForceStepResult>& results);

}  // namespace contour
