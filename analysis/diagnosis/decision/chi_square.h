#pragma once

#include <cstddef>

namespace contour::diagnosis {

/// What chi^2 of so many degrees of freedom (at least one) exceeds with the given probability, 0 < p < 1.
double ChiSquareQuantile(std::size_t degrees, double probability);

}  // namespace contour::diagnosis
