#include "analysis/axis_model/seen_with_lever.h"

#include "analysis/axis_model/stated_parameters.h"

namespace contour::diagnosis {

AxisModel SeenWithLever(AxisModel m, double lever) {
  for (double* x : {&m.motor_inertia, &m.load_inertia, &m.stiffness, &m.damping, &m.payload})
    *x *= lever * lever;
  for (double* x : {&m.gap, &m.start_bristle}) *x /= lever;
  for (double* x : {&m.rough, &m.saturation}) *x /= lever * lever;
  m.friction = SeenAtQ(m.friction, lever);
  m.offset *= lever;
  return m;
}

}  // namespace contour::diagnosis
