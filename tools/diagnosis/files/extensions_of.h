#pragma once

#include <string>
#include <vector>

#include "estimator/extension_config.h"
#include "tools/diagnosis/axis_log.h"
#include "tools/diagnosis/finding.h"

namespace contour::diagnosis {

/// Whether a model can be extended by causes of this kind. The others say what to mend (backlash, a payload
/// that changes), not what to reckon with.
bool CanExtend(const std::string& kind);

/// Adds the accepted causes to what a model has already. `mean_temperature_degC` is that of the log.
void AddCauses(const std::vector<Cause>& causes, double mean_temperature_degC, ExtensionsConfig& extensions);

/// Of the log; 20 without a sensor.
double MeanTemperature_degC(const AxisLog& log);

}  // namespace contour::diagnosis
