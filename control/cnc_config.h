#pragma once

#include "core/visit.h"

namespace contour {

/// What a numerical control compensates by fixed numbers (`control.cnc`). Forces and lengths are stated as
/// shares of the axis's own, so that one setting fits axes of any size; 1 is what the model says.
struct CncConfig {
  double lost_motion_share = 1.0;
  double lost_motion_travel_rel = 1.0;
  double friction_share = 1.0;
  double friction_travel_rel = 1.0;
  double viscous_share = 1.0;
  double pulse_share = 0.0;
  double pulse_ms = 10.0;
  double bend_share = 1.0;
  double lead_ms = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("lost_motion_share", lost_motion_share, Range{-2.0, 5.0},
               "position offset with the direction of motion, as a share of Fc / screw_stiffness");
    v.Optional("lost_motion_travel_rel", lost_motion_travel_rel, Range{0.01, 50.0},
               "travel after a reversal in which half of it turns round, as a share of Fc / sigma0");
    v.Optional("friction_share", friction_share, Range{-2.0, 5.0},
               "torque offset with the direction of motion, as a share of Fc");
    v.Optional("friction_travel_rel", friction_travel_rel, Range{0.01, 50.0},
               "travel in which it turns round but for 1/e, as a share of Fc / sigma0");
    v.Optional("viscous_share", viscous_share, Range{-2.0, 5.0},
               "torque offset with the velocity, as a share of sigma2");
    v.Optional("pulse_share", pulse_share, Range{-5.0, 5.0},
               "pulse of torque at a reversal, in the new direction, as a share of Fc");
    v.Optional("pulse_ms", pulse_ms, Range{0.5, 500.0}, "time in which the pulse fades to 1/e");
    v.Optional("bend_share", bend_share, Range{-20.0, 20.0},
               "position offset with the acceleration, as a share of table_mass / screw_stiffness");
    v.Optional("lead_ms", lead_ms, Range{0.0, 2.0}, "by how much the torque offset is early");
  }
};

}  // namespace contour
