#pragma once

#include "estimator/angle_force_map.h"
#include "estimator/filter_setup.h"

namespace contour {

/// How an axis's map of forces by its screw's angle learns, for every estimator that has one.
AngleForceMap::Tuning AngleForceTuning(const FilterSetup& setup);

}  // namespace contour
