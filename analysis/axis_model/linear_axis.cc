#include "analysis/axis_model/linear_axis.h"

namespace contour::diagnosis {

LinearAxis MakeLinearAxis(const AxisModel& m, double viscous) {
  LinearAxis axis;
  Eigen::Matrix4d& a = axis.dynamics;
  const double jm = m.motor_inertia;
  a(0, 1) = 1.0;
  axis.motor(1) = 1.0 / jm;
  if (!m.two_inertia) {
    a(1, 1) = -viscous / jm;
    return axis;
  }
  const double jl = m.load_inertia;
  axis.states = 4;
  axis.load(3) = 1.0 / jl;
  a(2, 3) = 1.0;
  a.row(1) << -m.stiffness / jm, -m.damping / jm, m.stiffness / jm, m.damping / jm;
  a.row(3) << m.stiffness / jl, m.damping / jl, -m.stiffness / jl, -m.damping / jl;
  if (m.friction_on_load)
    a(3, 3) -= viscous / jl;
  else
    a(1, 1) -= viscous / jm;
  return axis;
}

}  // namespace contour::diagnosis
