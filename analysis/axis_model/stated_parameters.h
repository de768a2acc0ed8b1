#pragma once

#include <map>
#include <optional>
#include <string>

#include "analysis/axis_model/stated_axis.h"

// What machine files and models that stand alone share before they become a StatedAxis.
namespace contour::diagnosis {

/// Friction stated in another coordinate, x = q * lever (m per rad for table values of a rotary axis).
StatedFriction SeenAtQ(StatedFriction friction, double lever);

/// The engine's names (Fc, s0, ...) with the largest uncertainty that a file states for any of the keys
/// behind each (Fc_plus_N, Fc_minus_Nm, ...). Inertias are not among them.
std::map<std::string, double> EngineSigmas(const std::map<std::string, double>& uncertainty);

/// Whether a key may stand under `uncertainty:` of a model that stands alone.
bool IsUncertaintyKey(const std::string& key);

/// Inertia entries of axis.sigma: of each inertia, or of their sum on a rigid axis.
void SetInertiaSigma(StatedAxis& axis, std::optional<double> motor, std::optional<double> load,
                     double motor_part, double load_part);

std::optional<double> Find(const std::map<std::string, double>& map, const std::string& key);

}  // namespace contour::diagnosis
