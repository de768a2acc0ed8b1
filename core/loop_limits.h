#pragma once

#include "core/visit.h"

namespace contour {

/// What the two-inertia loop of an axis must bear, `axes.<name>.loop_limits`. A peak is 1 / min |1 + L|: the
/// largest factor by which the loop makes a disturbance of any frequency larger. At 2 the gain may change by
/// a factor of 2 and the phase by 29 degrees.
struct LoopLimits {
  double peak_as_stated = 2.0;
  double peak_far_off = 2.5;
  double peak_late = 4.0;
  double uncertainty = 0.1;
  double smallest_uncertainty = 0.05;
  double far_off = 0.3;
  double force_step = 0.1;
  double torque_noise = 0.01;

  template <class Visitor>
  void Visit(Visitor& v) {
    constexpr Range kPeak{1.05, 100.0};
    constexpr Range kShare{0.0, 0.9, true};
    v.Optional("peak_as_stated", peak_as_stated, kPeak,
               "largest peak of sensitivity within the stated uncertainties, sliding, held by the friction's "
               "bristle, and on its falling slope");
    v.Optional("peak_far_off", peak_far_off, kPeak, "largest peak with stiffness and masses off by far_off");
    v.Optional("peak_late", peak_late, kPeak, "largest peak with one more cycle of delay");
    v.Optional("uncertainty", uncertainty, kShare,
               "relative uncertainty of stiffness and masses where model.uncertainty states none");
    v.Optional("smallest_uncertainty", smallest_uncertainty, kShare,
               "relative uncertainty that stiffness and masses have at least, whatever is stated");
    v.Optional("far_off", far_off, kShare, "relative error of stiffness and masses that must stay stable");
    v.Optional("force_step", force_step, kShare,
               "force on the table whose error is made small, in that of rated torque");
    v.Optional("torque_noise", torque_noise, kShare,
               "largest noise of the torque from the encoder's resolution, in rated torque");
  }
};

}  // namespace contour
