#pragma once

#include <string>

#include "analysis/axis_model/extension_keys.h"
#include "analysis/axis_model/stated_axis.h"
#include "analysis/axis_model/stated_axis_config.h"
#include "config/model_config.h"

// A StatedAxis back into the files that it may come from: its numbers and, under uncertainty:, their
// deviations. Extensions are the caller's.
namespace contour::diagnosis {

/// `config` has the keys of the model as it was read; what it states beyond numbers stays.
void IntoConfig(const StatedAxis& axis, ModelConfig& config);
void IntoConfig(const StatedAxis& axis, LooseAxisFile& file);

/// Such a file as text: keys that state nothing are left out.
std::string TextOf(const LooseAxisFile& file, ExtensionUnits units);

/// To five digits: more than that nobody knows.
double FiveDigits(double value);

}  // namespace contour::diagnosis
