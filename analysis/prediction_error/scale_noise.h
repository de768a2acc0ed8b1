#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/prediction_error/signals.h"

namespace contour::diagnosis {

/// The scale's residual without what a smooth function of the table's position explains of it (least squares,
/// the first cosines over the stroke): what its noise is learnt from. An error of the lead stands far above
/// the noise of a good scale, and would pass for it.
std::vector<double> WithoutShape(std::span<const double> residual, const std::vector<std::uint8_t>& counted,
                                 const Signals& signals);

/// Of a scale, by the smallest difference between neighbouring readings; infinite where it does not move.
double CountOf(std::span<const double> readings_m);

}  // namespace contour::diagnosis
