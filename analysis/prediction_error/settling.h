#pragma once

#include "analysis/diagnosis/tuning/prediction_tuning.h"

namespace contour::diagnosis {

/// [s] For so long prediction errors remember what was before.
inline constexpr double kSettling_s = kRows.settling_s;

}  // namespace contour::diagnosis
