#pragma once

#include "analysis/axis_model/stated_axis.h"
#include "estimator/extension_config.h"

namespace contour::diagnosis {

/// Extensions that are nothing but other numbers of the basic model. `axis` states the basic model, rotary.
void ApplyNumbers(const ExtensionsConfig& extensions, StatedAxis& axis);

/// The others: what `axis` has beyond its numbers.
void ApplyExtras(const ExtensionsConfig& extensions, StatedAxis& axis);

}  // namespace contour::diagnosis
