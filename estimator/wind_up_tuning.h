#pragma once

#include "estimator/filter_setup.h"
#include "estimator/wind_up_fit.h"

namespace contour {

/// What reversals may tell of an axis's screw, for every estimator that learns from them.
WindUpFit::Tuning WindUpTuning(const FilterSetup& setup);

}  // namespace contour
