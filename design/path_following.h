#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/machine_config.h"

namespace contour {

/// How far an axis's table is expected to be from a path that is planned for it, while not all of its
/// friction is known: under a force that steps by `loop_limits.force_step`, the mean error of the loop over
/// 200 ms. Where the drive closes the loop, or another one than that of two inertias runs, nothing is known
/// of it but how far the screw gives. (Measured on machines of the family:
/// docs/laboratory/motion_planning.md.)
double ExpectedFollowing_m(const MachineConfig& machine, const AxisConfig& axis);

/// Of the axis that is worst, mm, rounded as it stands in a file.
double ExpectedFollowing_mm(const MachineConfig& machine);

/// `machine.path_following_mm` as an assignment to put on top of a machine file that does not state it;
/// loops that are missing have to be in it (LoopsThatAreMissing).
std::vector<std::string> PathFollowingIfMissing(const MachineConfig& machine);

/// Where the path tolerance is wider than usual because the machine is expected to follow that badly and its
/// file states none: a sentence on it, for whoever runs programs. `machine` has its following stated or
/// chosen.
std::optional<std::string> WiderToleranceText(const MachineConfig& machine);

}  // namespace contour
