#pragma once

#include "analysis/prediction_error/fit.h"

namespace contour::diagnosis {

struct Jitter {
  bool tested = false;  ///< several speeds were there
  double drop = 0.0;    ///< square of the slope's t
  double rms_s = 0.0, sigma_s = 0.0;
  double sigma_s2 = 0.0;  ///< of the variance of the instants
};

/// Readings at uncertain instants: no mean effect, but a variance of the fast part of the white innovation
/// that grows with the square of the speed. Regression over short blocks on 1, speed^2 and acceleration^2,
/// errors from the blocks' own scatter.
Jitter TestJitter(const Problem& problem, const Fit& fit);

}  // namespace contour::diagnosis
