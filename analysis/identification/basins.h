#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace contour::identify {

/// Of errors along a line, the places that are lower than the ones next to them, the lowest first: where a
/// descent has somewhere to go. A slope that falls to the line's end counts once, however low all of it is.
std::vector<std::size_t> Basins(std::span<const double> errors);

}  // namespace contour::identify
