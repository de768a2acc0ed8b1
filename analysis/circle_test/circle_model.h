#pragma once

#include <string>

#include "analysis/circle_test/circle_test.h"
#include "config/model_config.h"

namespace contour {

CircleAxis CircleAxisOf(const std::string& name, const ModelConfig& model);

/// The model with what a circle told: share of friction, its uncertainty, and the wobble, where it is one.
void IntoModel(const CircleAxisFound& found, ModelConfig& model);

}  // namespace contour
