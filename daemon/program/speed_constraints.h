#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "daemon/program/speed_optimiser.h"

namespace contour {

/// The path about a window of nodes, and what holds there. Speed is a quadratic between nodes, so that what
/// holds at some places of an interval hardly fails between them.
struct SpeedConstraints {
  struct Place {
    double cap = 0.0;        ///< of w, hard
    double feed_cap = 0.0;   ///< of w, soft; infinite: none
    double width_u = 0.0;    ///< that it stands for
    double allowance = 1.0;  ///< times the limits, where the motion to begin with is a little beyond them
    PerAxis<double> first, second, third;
  };
  /// Evenly from begin to end of every interval between nodes; the third derivative is the interval's own.
  std::vector<std::array<Place, kSpeedPlaces>> intervals;
  PerAxis<double> acceleration, jerk;
};

SpeedConstraints ConstraintsOf(const Stretch& stretch, const RestMap& map, const SpeedGoal& goal,
                               const SpeedSpline& speed, std::size_t first_node, std::size_t last_node);

/// Share of the limits of acceleration and jerk that the motion takes at a place; `slope` and `bend` are
/// derivatives of w by the parameter.
inline double UseOf(const SpeedConstraints& c, const SpeedConstraints::Place& p, double w, double slope,
                    double bend) {
  double used = 0.0;
  for (std::size_t a = 0; a < p.first.size(); ++a) {
    used = std::max(
        {used, std::abs(p.second[a] * w + 0.5 * p.first[a] * slope) / c.acceleration[a],
         std::sqrt(w) * std::abs(p.third[a] * w + 1.5 * p.second[a] * slope + 0.5 * p.first[a] * bend) /
             c.jerk[a]});
  }
  return used;
}

/// The largest share of all limits in the intervals of `c`, the first of which begins at `first_node`.
double LargestUse(const SpeedConstraints& c, const SpeedSpline& speed, std::size_t first_node);

}  // namespace contour
