#pragma once

#include "core/axis.h"
#include "core/visit.h"

namespace contour {

/// The mechanics of one ball-screw axis as the machine file states them (`model:`). Field names are the YAML
/// keys.
struct MechanicsConfig {
  double lead_mm = 0.0;
  double motor_inertia_kgm2 = 0.0;  ///< motor, coupling and screw
  double table_mass_kg = 0.0;
  double screw_stiffness_N_um = 0.0;
  double screw_damping_Ns_m = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("lead_mm", lead_mm, Range{0.1, 200.0}, "travel of the table per motor turn");
    v.Required("motor_inertia_kgm2", motor_inertia_kgm2, kPositive, "inertia of motor, coupling and screw");
    v.Required("table_mass_kg", table_mass_kg, kPositive, "moving mass of the table");
    v.Required("screw_stiffness_N_um", screw_stiffness_N_um, kPositive,
               "axial stiffness between motor and table");
    v.Required("screw_damping_Ns_m", screw_damping_Ns_m, kNotNegative,
               "axial damping between motor and table");
  }
};

/// The same in SI, as the cycle uses it.
struct Mechanics {
  double radius_m_rad = 0.0;   ///< R = lead / (2 pi)
  double mass_kg = 0.0;        ///< m = Jm / R^2 + Mt, everything seen at the table
  double table_mass_kg = 0.0;  ///< Mt
  double stiffness_N_m = 0.0;  ///< K
  double damping_Ns_m = 0.0;   ///< c
};

constexpr Mechanics ToSi(const MechanicsConfig& c) noexcept {
  const double r = ScrewRadius_m_rad(c.lead_mm);
  return {r, c.motor_inertia_kgm2 / (r * r) + c.table_mass_kg, c.table_mass_kg, c.screw_stiffness_N_um * 1e6,
          c.screw_damping_Ns_m};
}

}  // namespace contour
