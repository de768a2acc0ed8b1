#pragma once

#include <string>
#include <vector>

#include "analysis/diagnosis/result/finding.h"
#include "analysis/recording/axis_log.h"
#include "estimator/extension_config.h"

namespace contour::diagnosis {

/// Whether a model can be extended by causes of this kind. The others say what to mend (backlash, a payload
/// that changes), not what to reckon with.
bool CanExtend(const std::string& kind);

/// Adds the accepted causes to what a model has already. `first_temperature_degC` is that of the log; rates
/// refer to it.
void AddCauses(const std::vector<Cause>& causes, double first_temperature_degC, ExtensionsConfig& extensions);

/// Of a log: its first temperature, and that farthest from it; 20 without a sensor.
struct LogTemperature {
  double first_degC = 20.0, farthest_degC = 20.0;
};
LogTemperature TemperatureOf(const AxisLog& log);

}  // namespace contour::diagnosis
