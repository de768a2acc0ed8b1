#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/machine_config.h"

namespace contour {

/// What a machine file may state but should not, for its drives' mode: a sentence each. Nothing is refused
/// for it.
std::vector<std::string> ModeAdvice(const MachineConfig& machine);

/// Of an axis in torque mode whose drive is expected to draw better circles: the sentence that says so.
/// `compliance_m_N` as in CircleErrorByTorque_m.
std::optional<std::string> AdviceForDrive(const std::string& axis_name, const AxisConfig& axis,
                                          double compliance_m_N, double period_s);

}  // namespace contour
