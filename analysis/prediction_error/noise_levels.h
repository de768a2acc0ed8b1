#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/prediction_error/kalman_pass.h"

namespace contour::diagnosis {

/// Three numbers that say how torque and reading scatter, next to the size of all of it.
struct NoiseLevels {
  /// Variance of a row's white torque, in units in which a torque as large as the
  /// reading's noise moves the axis in one row by as much, over the reading's.
  double log10_torque = 0.0;
  bool slow_there = false;         ///< whether there is a first-order torque noise next to the white one
  double log10_slow = 0.0;         ///< its spectral density at 0 Hz over the white one's
  double log10_memory_rows = 0.0;  ///< after which 1 / e is left of it
};

/// `reading`, `unit`: as in LevelsSearch.
NoiseVariances VariancesOf(const NoiseLevels& levels, double reading, double unit);

/// What the search goes by.
struct LevelsSearch {
  const std::vector<std::uint8_t>& counted;
  double period_s = 0.0;
  double reading = 0.0;     ///< [rad^2] variance
  double unit = 0.0;        ///< [Nm/rad] inertia over period squared
  bool slow_torque = true;  ///< whether one is looked for
};

/// The likeliest, from segments all over the log. `before`: of an earlier run of the log, near which they
/// lie; null: none.
NoiseLevels LikeliestLevels(const LinearModel& model, const LevelsSearch& search, const NoiseLevels* before);

/// With fewer rows the filter does not settle in all of these segments, and the levels say nothing.
std::size_t FewestRowsOfLevels();

}  // namespace contour::diagnosis
