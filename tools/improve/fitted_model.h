#pragma once

#include <vector>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/diagnosis/result/finding.h"
#include "config/model_config.h"

namespace contour::improve {

/// Models that a diagnosis leads to, of which drawing has to show the better one: first the one that it would
/// write, then, where that foresees free runs, the one of its one-step errors. None where it changes nothing.
/// `stated` is `model` as the diagnosis began with it; rates refer to the log's first temperature. How well
/// numbers are known stays as stated: what a fit says of that does not hold where something is missing.
std::vector<ModelConfig> FittedModels(const ModelConfig& model, const diagnosis::StatedAxis& stated,
                                      const diagnosis::Diagnosis& found, double first_temperature_degC);

}  // namespace contour::improve
