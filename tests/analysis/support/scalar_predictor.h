#pragma once

#include <vector>

#include "analysis/prediction_error/forward_filter.h"

namespace contour::diagnosis::test {

/// The forward model once more, one run at a time and in plain numbers: what the batched loops of simd/ are
/// compared with. The coupling moves by a matrix exponential, friction by std::exp.
std::vector<double> ScalarInnovation(const FilterSetup& setup, const AxisModel& model);

}  // namespace contour::diagnosis::test
