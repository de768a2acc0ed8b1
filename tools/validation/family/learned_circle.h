#pragma once

#include <array>
#include <string>
#include <vector>

#include "analysis/circle_test/circle_test.h"
#include "tools/validation/family/family_run.h"

namespace contour {

/// What one measured circle tells `full` of this machine (analysis/circle_test), as assignments for its file:
/// the large circle, drawn once by the drives alone with the seed and program that `cnc` is tuned on, its
/// radius measured as by a ball bar. Throws std::runtime_error with what went wrong.
std::vector<std::string> LearnCircle(const std::string& folder, FamilyCell cell);

/// A ball bar's record of whole turns: one reading per degree, the mean over it, in steps of its resolution.
std::vector<CirclePoint> BallBar(const std::vector<std::array<double, kCircleAxes>>& table_m);

}  // namespace contour
