#pragma once

#include <string>
#include <vector>

#include "tools/identify/axis_model.h"
#include "tools/identify/kinematics.h"
#include "tools/identify/simulation.h"

namespace contour::identify {

/// Response of the motor's position to the force at the motor where a chirp excited it.
struct ResponsePoint {
  double frequency_Hz = 0.0;
  double accelerance_1_kg = 0.0;  ///< |x| (2 pi f)^2 / |F|: 1 / mass where the axis is rigid
  double coherence = 0.0;
};

/// The screw from its antiresonance and resonance:
///   K = Mt (2 pi f_ar)^2, (f_r / f_ar)^2 = m / m_motor, m = m_motor + Mt known.
struct ScrewResonance {
  bool found = false;
  std::string why_not;
  double antiresonance_Hz = 0.0, resonance_Hz = 0.0;
  double motor_mass_kg = 0.0, table_mass_kg = 0.0, stiffness_N_m = 0.0, damping_Ns_m = 0.0;
  std::vector<ResponsePoint> response;
};
ScrewResonance FindResonance(const std::vector<Measured>& records, double mass_kg);

/// With a linear scale: motor minus table regressed on the force through the screw.
struct ScrewWindUp {
  bool found = false;
  double stiffness_N_m = 0.0;
  double sigma_rel = 0.0;  ///< from the scatter over blocks of a second
};
ScrewWindUp FitWindUp(const std::vector<Measured>& records, const AxisModel& axis);

}  // namespace contour::identify
