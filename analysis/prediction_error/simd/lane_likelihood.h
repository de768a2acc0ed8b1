#pragma once

#include <cstddef>
#include <cstdint>

#include "analysis/prediction_error/simd/lanes.h"

namespace contour::diagnosis {

/// The time-varying Kalman filter on some rows of a linearised model, with a noise of its own in each lane:
/// what its innovations add to -2 log likelihood. Transitions as LaneColumns has them.
struct LaneLikelihood {
  std::size_t from = 0, to = 0, stride = 0;
  int states = 0;            ///< of the model
  bool slow = false;         ///< whether any lane has a slow torque, one more state
  std::size_t settling = 0;  ///< rows at the beginning that do not count
  double most_square = 0.0;  ///< of its variance, that a single reading counts by; mean of those so far
  double start_w = 0.0;      ///< variance of the speeds at the beginning
  const float* step = nullptr;
  const std::uint8_t *valid = nullptr, *counted = nullptr;
  const double* innovation = nullptr;
  const std::size_t* begins = nullptr;  ///< rows from which nothing is left of what was before
  std::size_t begins_count = 0;
  std::size_t lanes = 0;                                                    ///< that are asked for
  double reading = 0.0;                                                     ///< variance
  double torque[kLanes] = {}, slow_torque[kLanes] = {}, keep[kLanes] = {};  ///< as NoiseVariances has them
  double squares[kLanes] = {}, logs[kLanes] = {}, count = 0.0;              ///< what is added to
};

}  // namespace contour::diagnosis
