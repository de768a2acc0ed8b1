#pragma once

#include <string>

#include "config/machine_config.h"
#include "daemon/program/motion_plan.h"
#include "design/commission_plan.h"

// Where the axes may be while a model is improved, and where in it a program begins.
namespace contour::improve {

/// What each axis is allowed; limits of the one that is improved, and of the others in proportion.
struct AxisSpace {
  double low_m = 0.0, high_m = 0.0;
  double margin_m =
      0.0;  ///< that programs stay inside: an axis follows with an error, but with no larger one
  double max_speed_m_s = 0.0;
  double max_torque_Nm = 0.0;
};
struct WorkingSpace {
  std::size_t axis = 0;  ///< that is improved
  std::vector<std::string> names;
  PerAxis<AxisSpace> axes;
};

/// `limits` are the improved axis's; every other axis has the same way and speed, at most its own limits, and
/// the same share of its torque. Each way lies about where the axis stands, inside limits.position_mm. Throws
/// ConfigError where the limits do not fit the improved axis.
WorkingSpace SpaceFor(const MachineConfig& machine, const std::string& axis, const CommissionLimits& limits,
                      const PerAxis<double>& position_m);

/// A program as the daemon takes it.
struct ProgramText {
  std::string name;
  std::string text;
  ProgramFormat format = ProgramFormat::kYaml;
};

/// Where a program is to begin, so that all of it is inside.
struct Placed {
  ProgramText program;
  PerAxis<double> start_m;
  double duration_s = 0.0;
  std::vector<bool> moves;  ///< axes that the program moves
};

/// A place inside the space, as near as can be to `preferred_m`. Throws ConfigError where the program is too
/// large or too fast for the space, or not one for this machine.
Placed Place(const ProgramText& program, const WorkingSpace& space, const PerAxis<PlanLimits>& limits,
             const PerAxis<double>& preferred_m);

/// A straight way from one place to another at half the speed that is allowed; empty text where there is
/// nothing to move. One program per axis, one after the other: axis names may be any.
std::vector<ProgramText> WayTo(const PerAxis<double>& from_m, const PerAxis<double>& to_m,
                               const WorkingSpace& space);

/// For people, one line for each axis.
std::string Describe(const WorkingSpace& space);

}  // namespace contour::improve
