#pragma once

#include <span>

#include "analysis/prediction_error/forward_filter.h"
#include "analysis/prediction_error/simd/lane_linear.h"
#include "analysis/prediction_error/simd/lane_run.h"

namespace contour::diagnosis {

/// Models of one shape as lanes; the last one fills the lanes that remain. Outputs are for the caller
/// to set. Everything given must outlive the lanes.
Lanes MakeLanes(const FilterSetup& setup, std::span<const AxisModel* const> models,
                std::span<const Delivered* const> delivered, const double* measured, const double* zeros);

/// The same over one segment of the log; outputs go where the segment is kept.
Lanes Over(const Lanes& lanes, const Segment& segment);

}  // namespace contour::diagnosis
