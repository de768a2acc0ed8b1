#include "config/screw_advice.h"

#include <cmath>
#include <numbers>

#include "config/number_text.h"

namespace contour {
namespace {

// Of steel.
constexpr double kElasticity_Pa = 2.1e11;
constexpr double kDensity_kg_m3 = 7850.0;

}  // namespace

StiffestScrew StiffestScrewOf(double motor_inertia_kgm2, double stroke_m) {
  // A cylinder's inertia about its axis is density pi length d^4 / 32. The nut in the middle hangs on both
  // halves, each of stiffness E A / (length / 2).
  StiffestScrew screw;
  screw.diameter_m =
      std::pow(32.0 * motor_inertia_kgm2 / (std::numbers::pi * kDensity_kg_m3 * stroke_m), 0.25);
  const double area_m2 = 0.25 * std::numbers::pi * screw.diameter_m * screw.diameter_m;
  screw.stiffness_N_m = 4.0 * kElasticity_Pa * area_m2 / stroke_m;
  return screw;
}

std::vector<std::string> ScrewAdvice(const MachineConfig& machine) {
  std::vector<std::string> lines;
  for (const auto& [name, axis] : machine.axes) {
    const double stroke_mm = axis.limits.position_mm[1] - axis.limits.position_mm[0];
    const MechanicsConfig& m = axis.model.mechanics;
    const StiffestScrew most = StiffestScrewOf(m.motor_inertia_kgm2, 1e-3 * stroke_mm);
    const double most_N_um = 1e-6 * most.stiffness_N_m;
    if (m.screw_stiffness_N_um <= most_N_um) continue;
    lines.push_back("axes." + name + ".model.screw_stiffness_N_um: found " +
                    RoundedText(m.screw_stiffness_N_um) + " N/um, expected less than " +
                    RoundedText(most_N_um) + ": no ball screw is stiffer, in the middle of " +
                    RoundedText(stroke_mm) +
                    " mm between bearings at both ends, whose inertia is within "
                    "motor_inertia_kgm2 (of steel, " +
                    RoundedText(1e3 * most.diameter_m) +
                    " mm thick: 4 E A / length). Is it in N/um, and the inertia in kg m^2?");
  }
  return lines;
}

}  // namespace contour
