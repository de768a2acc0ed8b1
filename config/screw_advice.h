#pragma once

#include <string>
#include <vector>

#include "config/machine_config.h"

namespace contour {

/// The thickest screw whose own inertia fits into that of the motor, and how stiff it is along its axis.
struct StiffestScrew {
  double diameter_m = 0.0;
  double stiffness_N_m = 0.0;
};

/// Of steel and as long as the stroke, held at both ends, the nut in the middle; all of `motor_inertia_kgm2`
/// (motor, coupling and screw) its own. A real screw is longer, and part of the inertia is the motor's.
StiffestScrew StiffestScrewOf(double motor_inertia_kgm2, double stroke_m);

/// Of each axis whose stiffness no ball screw has, say because it is stated in N/m: what is wrong with it, in
/// a line. Warnings only: a nut that is driven turns no screw, and a linear motor has none.
std::vector<std::string> ScrewAdvice(const MachineConfig& machine);

}  // namespace contour
