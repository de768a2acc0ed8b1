#pragma once

#include <vector>

#include "daemon/program/stretch.h"

namespace contour {

/// The map for a way from rest at `from_m`, to rest at the stretch's end: it starts and ends over what a jerk
/// phase takes.
RestMap RestMapFor(const Stretch& stretch, double from_m);

/// Parameters at which the speed along a path is decided: all places where the path's third derivative or the
/// feed jumps, and as many between them as changes of speed at the axes' limits need. Sparse where the feed
/// is kept.
std::vector<double> SpeedGrid(const Stretch& stretch, const RestMap& map, double feed_scale);

/// Time between nodes where the speed changes at the axes' limits.
double StepTime_s(const Stretch& stretch, double way_m, double speed_m_s);

}  // namespace contour
