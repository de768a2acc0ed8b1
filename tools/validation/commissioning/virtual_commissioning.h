#pragma once

#include <map>
#include <string>
#include <vector>

#include "analysis/identification/identification.h"
#include "analysis/recording/axis_log.h"
#include "design/commission_plan.h"
#include "tools/machine/load_emulated_machine.h"

namespace contour {

/// The example machine of a seed whose model is wrong: every friction value by `friction_rel`, both inertias
/// by `inertia_rel` (one way), each value up or down as the seed says.
EmulatedMachineFile WrongMachine(unsigned seed, double friction_rel, double inertia_rel);

/// What the emulated axis really is, by the keys that identification uses, SI at the table; friction levels
/// as averages over the stretch.
std::map<std::string, double> Truth(const EmulatedMachineFile& file, const std::string& axis, double low_m,
                                    double high_m);

/// Commissioning in virtual time, the same motions as through a daemon.
struct VirtualCommissioning {
  diagnosis::AxisLog log;
  CommissionPlan plan;
  double machine_time_s = 0.0;  ///< from enabling to the end
  double low_m = 0.0, high_m = 0.0;
  double largest_torque_Nm = 0.0, largest_speed_m_s = 0.0, largest_following_error_m = 0.0;
};
VirtualCommissioning Commission(const EmulatedMachineFile& file, const std::string& axis,
                                const std::string& controller);

/// The same parameters as Truth(), of a result.
std::map<std::string, identify::FittedParameter> Found(const identify::Identification& id);

}  // namespace contour
