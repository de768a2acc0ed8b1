#pragma once

#include <string>
#include <vector>

#include "config/machine_config.h"

namespace contour {

/// What a sound axis may be away from its path in csp, by its motor: the distance that following_error_mm is
/// held against.
struct FollowingRoom {
  double wound_mm = 0.0;     ///< by the screw's wind-up
  double late_mm = 0.0;      ///< at the highest speed, should the drive answer one cycle later than stated
  double feed_mm_s = 0.0;    ///< up to which both are within the limit
  double expected_mm = 0.0;  ///< limit that leaves room for both
};

FollowingRoom FollowingRoomOf(const MachineConfig& machine, const AxisConfig& axis);

/// A sentence for each axis in csp whose limit leaves too little of it. Nothing is refused: the stop is what
/// was asked for.
std::vector<std::string> FollowingAdvice(const MachineConfig& machine);

}  // namespace contour
