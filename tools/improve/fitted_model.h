#pragma once

#include "analysis/diagnosis/result/finding.h"
#include "config/model_config.h"

namespace contour::improve {

/// The model with the numbers that a diagnosis has fitted, and extended by the causes that it has found.
/// Rates refer to the log's first temperature.
ModelConfig FittedModel(ModelConfig model, const diagnosis::Diagnosis& found, double first_temperature_degC);

}  // namespace contour::improve
