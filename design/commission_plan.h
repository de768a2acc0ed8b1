#pragma once

#include <string>
#include <vector>

#include "config/machine_config.h"

namespace contour {

/// What commissioning may do to an axis, all within the axis's own limits.
struct CommissionLimits {
  double travel_mm = 0.0;  ///< whole way, from end to end
  double max_speed_mm_s = 0.0;
  double max_torque_Nm = 0.0;
};

/// Shares of the axis's limits: a tenth of the stroke and at most 20 mm, but a turn of the motor, four tenths
/// of the speed and at most 100 mm/s, six tenths of the torque.
CommissionLimits DefaultCommissionLimits(const AxisConfig& axis);

/// One motion, as a program of its own.
struct CommissionMotion {
  std::string what;  ///< in a few words
  std::string yaml;
};

struct CommissionPlan {
  std::string axis;
  CommissionLimits limits;
  double low_mm = 0.0, high_mm = 0.0;  ///< where the axis will be
  double largest_torque_Nm = 0.0;      ///< expected, by the stated model with half as much friction again
  std::vector<CommissionMotion> motions;
};

/// The motions for an axis that stands at `position_mm`. Slow ones come first, and nothing of it needs the
/// model to be right: friction and inertia may be half as large again, or half. Throws ConfigError when the
/// limits do not fit the axis or leave too little to identify anything. In csp the drive's loop leads the
/// axis, and what is added is an offset of its torque (0x60B2).
CommissionPlan PlanCommissioning(const MachineConfig& machine, const std::string& axis, double position_mm,
                                 const CommissionLimits& limits);

/// What shows more of a screw that the chirp of such a plan did not show: the strokes' speed goes by their
/// way, and by that the force that may shake them without turning them back.
std::string MoreOfTheScrew(const AxisConfig& axis, double travel_mm);

/// For people: the motions, the way, the largest speed and torque.
std::string Describe(const CommissionPlan& plan);

}  // namespace contour
