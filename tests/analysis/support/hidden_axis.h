#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/recording/axis_log.h"

// A second maker of logs, for tests only. It shares nothing with the engine but the vocabulary: its own
// friction, its own integrator (midpoint, 25 us), its own effects written as physics and not as regressors.
namespace contour::diagnosis::test {

struct HiddenEffect {
  std::string
      kind;  ///< a cause, or one outside the catalogue: torque_ripple, torque_limit, push, friction_step
  double size = 0.0;  ///< main parameter, in units of MakeSize()
  double order = 0.0, phase = 0.0, extra = 0.0;
};

struct HiddenOptions {
  std::uint64_t seed = 1;
  double duration_s = 60.0;
  bool two_inertia = false;
  bool friction_on_load = false;
  bool linear = false;
  bool scale = true, temperature = true, axis2 = true;
  double torque_noise_rel = 0.005;  ///< of rated, white per row
  double encoder_step_rad = 0.0;    ///< 0: 17 bit
  double parameter_spread = 1.0;    ///< of the stated standard deviations between model and truth
  double timing_error_s = 0.0;      ///< of the readings
  double noise_change = 1.0;        ///< factor on the noise in the second half
  double delay_lag_factor = 1.0;    ///< truth over stated
  bool maxwell_slip = false;
  std::vector<HiddenEffect> effects;
};

struct HiddenAxis {
  AxisLog log;
  StatedAxis stated;
};

HiddenAxis MakeHiddenAxis(const HiddenOptions& options);
/// As it is by default, for so long.
HiddenAxis HiddenAxisFor(double duration_s);

}  // namespace contour::diagnosis::test
