#pragma once

#include <vector>

#include "analysis/identification/simulation.h"
#include "analysis/identification/table_axis.h"

namespace contour::identify {

/// With a linear scale: motor minus table regressed on the force through the screw.
struct ScrewWindUp {
  bool found = false;
  double stiffness_N_m = 0.0;
  double sigma_rel = 0.0;  ///< from the scatter over blocks of a second
};
ScrewWindUp FitWindUp(const std::vector<Measured>& records, const TableAxis& axis);

}  // namespace contour::identify
