#include "config/circle_errors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/mechanics.h"

namespace contour {
namespace {

// Of Coulomb friction, what acts like a force that nobody foresees: through the screw alone, and through the
// loop. Of a drive with the resolution of its encoder, in counts.
constexpr double kOfScrew = 0.25;
constexpr double kOfLoop = 0.06;
constexpr double kCounts = 7.0;
// The same where nothing that is made from what it reports comes back to it, or only averaged. With it the
// 10 mm circles that were measured on three machines of 10 000 and 16 384 counts a turn are expected to
// within a fifth (docs/laboratory/family.md).
constexpr double kCountsAlone = 3.0;
// The same of a loop in torque mode that was made for the encoder, on three machines.
constexpr double kCountsByTorque = 2.5;
// The loops of most axes, in what the screw gives way by under all of Coulomb friction.
constexpr double kUsual = 0.5;

double Coulomb_N(const AxisConfig& axis) {
  const Mechanics m = ToSi(axis.model.mechanics);
  const Friction f = ToSi(axis.model.friction, m.radius_m_rad);
  return 0.5 * (f.Fc_plus_N + f.Fc_minus_N);
}

double WindUp_m(const AxisConfig& axis) { return Coulomb_N(axis) / ToSi(axis.model.mechanics).stiffness_N_m; }

double Count_m(const AxisConfig& axis) {
  return 1e-3 * axis.model.mechanics.lead_mm / axis.drive.encoder_counts_per_rev;
}

// The 10 mm circle.
constexpr double kFeed_m_s = 0.05;
constexpr double kRadius_m = 0.01;
// Equal parts of what friction turns round by.
constexpr int kParts = 64;

// How far the table swings beyond, on its screw with the motor held, over how far it gives way. Friction
// turns round along the travel from the reversal as its bristles bend, 1 - exp(-travel / bending); each part
// of it strikes the table when it comes, and half a period later it is where it swings to.
double SwingsBeyond(const AxisConfig& axis) {
  const Mechanics m = ToSi(axis.model.mechanics);
  const Friction f = ToSi(axis.model.friction, m.radius_m_rad);
  if (!(f.sigma0_N_m > 0.0) || !(m.table_mass_kg > 0.0)) return 0.0;
  const double damping = 0.5 * m.damping_Ns_m / std::sqrt(m.stiffness_N_m * m.table_mass_kg);
  if (damping >= 1.0) return 0.0;
  const double swing_rad_s = std::sqrt((1.0 - damping * damping) * m.stiffness_N_m / m.table_mass_kg);
  const double away_m_s2 = std::min(kFeed_m_s * kFeed_m_s / kRadius_m, 1e-3 * axis.limits.acceleration_mm_s2);
  const double bending_m = Coulomb_N(axis) / f.sigma0_N_m;
  double in_phase = 0.0, across = 0.0;
  for (int part = 0; part < kParts; ++part) {
    const double left = 1.0 - (part + 0.5) / kParts;
    const double phase_rad = swing_rad_s * std::sqrt(-2.0 * bending_m * std::log(left) / away_m_s2);
    in_phase += std::cos(phase_rad) / kParts;
    across += std::sin(phase_rad) / kParts;
  }
  const double half_period = std::numbers::pi * damping / std::sqrt(1.0 - damping * damping);
  return std::hypot(in_phase, across) * std::exp(-half_period);
}

}  // namespace

double CircleErrorByDrive_m(const AxisConfig& axis, bool averaged) {
  const double counts = averaged ? kCountsAlone : kCounts;
  return kOfScrew * WindUp_m(axis) * (1.0 + SwingsBeyond(axis)) + counts * Count_m(axis);
}

double CircleErrorByDriveAlone_m(const AxisConfig& axis) {
  return WindUp_m(axis) + kCountsAlone * Count_m(axis);
}

double CircleErrorByTorque_m(const AxisConfig& axis, double compliance_m_N) {
  return kOfLoop * compliance_m_N * Coulomb_N(axis);
}

double UsualCircleErrorByTorque_m(const AxisConfig& axis) {
  return kUsual * WindUp_m(axis) + kCountsByTorque * Count_m(axis);
}

}  // namespace contour
