#pragma once

#include <cstdint>
#include <vector>

#include "analysis/prediction_error/kalman_pass.h"

namespace contour::diagnosis {

/// Three numbers that say how torque and reading scatter, next to the size of all of it.
struct NoiseLevels {
  /// Decimal logarithm: variance of a row's white torque, in units in which a torque as large as the
  /// reading's noise moves the axis in one row by as much, over the reading's.
  double torque = 0.0;
  bool slow_there = false;  ///< whether there is a first-order torque noise next to the white one
  double slow = 0.0;        ///< decimal logarithm: its spectral density at 0 Hz over the white one's
  double memory = 0.0;      ///< decimal logarithm of the rows after which 1 / e is left of it
};

NoiseVariances VariancesOf(const NoiseLevels& levels, double reading, double unit);

/// The likeliest, from segments all over the log. `unit`: [Nm/rad] inertia over period squared; `before`: of
/// an earlier run of the log, near which they lie; null: none.
/// `slow_torque`: whether one is looked for.
NoiseLevels LikeliestLevels(const LinearModel& model, const std::vector<std::uint8_t>& counted,
                            double period_s, double reading, double unit, const NoiseLevels* before,
                            bool slow_torque = true);

}  // namespace contour::diagnosis
