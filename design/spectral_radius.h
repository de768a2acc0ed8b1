#pragma once

#include "design/loop_plant.h"

namespace contour {

/// The largest magnitude of an eigenvalue of a square matrix: what a loop grows by in a cycle. Infinite where
/// the iteration does not end, as with numbers that are none: such a loop is not shown to be stable.
double SpectralRadius(const LoopMatrix& matrix);

}  // namespace contour
