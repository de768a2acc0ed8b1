#pragma once

#include "estimator/friction_config.h"

namespace contour {

/// Whether a count of the encoder is more than Coulomb friction that turns round moves the axis by within a
/// period, F T^2 / 2m. Such friction is not seen by then, while a drive that closes the loop answers each
/// count: what it reports is the noise of its own readings, and the axis shakes. Of an axis without friction
/// there is nothing to hide.
[[nodiscard]] constexpr bool CountsHideFriction(double encoder_step_m, const Friction& friction,
                                                double mass_kg, double period_s) noexcept {
  const double level_N = 0.5 * (friction.Fc_plus_N + friction.Fc_minus_N);
  return level_N > 0.0 && mass_kg * encoder_step_m > 0.5 * level_N * period_s * period_s;
}

}  // namespace contour
