#include "analysis/axis_model/axis_model.h"

namespace contour::diagnosis {

AxisModel ModelOf(const StatedAxis& s) {
  AxisModel m;
  m.two_inertia = s.two_inertia;
  m.friction_on_load = s.friction_on_load && s.two_inertia;
  m.motor_share = m.friction_on_load ? s.motor_share : 0.0;
  m.motor_inertia = s.motor_inertia;
  m.load_inertia = s.load_inertia;
  m.stiffness = s.stiffness;
  m.damping = s.damping;
  m.friction = s.friction;
  m.offset = s.offset;
  m.delay_s = s.delay_s;
  m.lag_s = s.lag_s;
  return m;
}

}  // namespace contour::diagnosis
