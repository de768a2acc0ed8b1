#pragma once

namespace contour::identify {

struct AxisLanes;

/// Translations of the loop. That for AVX2 multiplies and adds in one rounding; the baseline differs from it
/// by rounding.
void RunAxisLanesBaseline(const AxisLanes& lanes);
void RunAxisLanesAvx2(const AxisLanes& lanes);

}  // namespace contour::identify
