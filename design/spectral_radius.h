#pragma once

#include "design/loop_plant.h"

namespace contour {

/// The largest magnitude of an eigenvalue of a square matrix: what a loop grows by in a cycle. Infinite where
/// the iteration does not end, as with numbers that are none: such a loop is not shown to be stable. One that
/// is smaller than `below` may be told too large, but below that, in less time.
double SpectralRadius(const LoopMatrix& matrix, double below = 0.0);

}  // namespace contour
