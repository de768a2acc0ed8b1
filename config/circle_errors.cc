#include "config/circle_errors.h"

#include "core/mechanics.h"

namespace contour {
namespace {

// Of Coulomb friction, what acts like a force that nobody foresees: through the screw alone, and through the
// loop. Of a drive with the resolution of its encoder, in counts.
constexpr double kOfScrew = 0.25;
constexpr double kOfLoop = 0.06;
constexpr double kCounts = 7.0;
// The loops of most axes, in what the screw gives way by under all of Coulomb friction.
constexpr double kUsual = 0.5;

double Coulomb_N(const AxisConfig& axis) {
  const Mechanics m = ToSi(axis.model.mechanics);
  const Friction f = ToSi(axis.model.friction, m.radius_m_rad);
  return 0.5 * (f.Fc_plus_N + f.Fc_minus_N);
}

double WindUp_m(const AxisConfig& axis) { return Coulomb_N(axis) / ToSi(axis.model.mechanics).stiffness_N_m; }

}  // namespace

double CircleErrorByDrive_m(const AxisConfig& axis) {
  const double count_m = 1e-3 * axis.model.mechanics.lead_mm / axis.drive.encoder_counts_per_rev;
  return kOfScrew * WindUp_m(axis) + kCounts * count_m;
}

double CircleErrorByTorque_m(const AxisConfig& axis, double compliance_m_N) {
  return kOfLoop * compliance_m_N * Coulomb_N(axis);
}

double UsualCircleErrorByTorque_m(const AxisConfig& axis) { return kUsual * WindUp_m(axis); }

}  // namespace contour
