#pragma once

#include <cstddef>
#include <vector>

#include "daemon/program/speed_spline.h"
#include "daemon/program/stretch.h"

namespace contour {

/// More nodes after `node`, where the present speed leaves too few for changing it: enough for a way over
/// `nodes` of them, or to where it is slower than `slow_m_s`. The speed stays what it is.
void RefineForChange(const Stretch& stretch, const RestMap& map, std::size_t node, std::size_t nodes,
                     double slow_m_s, SpeedSpline& speed);

/// The nodes of another grid too, as far as they are not next to one that is there, over the `nodes` nodes
/// after `node`.
void RefineByGrid(const std::vector<double>& grid, std::size_t node, std::size_t nodes, SpeedSpline& speed);

}  // namespace contour
