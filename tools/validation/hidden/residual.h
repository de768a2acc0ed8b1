#pragma once

#include "analysis/recording/axis_log.h"
#include "tools/validation/hidden/hidden_case.h"

namespace contour::hidden {

/// Variances that the strength of an effect is a share of (DIAGNOSIS, "Strength of an effect").
struct Residuals {
  double torque_Nm2 = 0.0;         ///< torque residual, 0-100 Hz, after the base model was refitted
  double scale_m2 = 0.0;           ///< scale residual, the same; 0 without a scale
  double second_difference = 0.0;  ///< of the angle, rad^2
};

/// By inverse dynamics about the true base parameters, each free within its stated uncertainty. Its friction
/// and its arithmetic are its own; the engine's are not used.
Residuals ResidualsOf(const diagnosis::AxisLog& log, const Setting& setting);

/// The one that counts for this kind.
double Relevant(const Residuals& residuals, const std::string& kind);

}  // namespace contour::hidden
