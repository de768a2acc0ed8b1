#pragma once

#include <string>
#include <vector>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/axis_model/stated_axis_config.h"
#include "config/yaml_tree.h"

namespace contour::diagnosis {

/// The axis that a model alone states. `model_key` is where the model stands in `tree` ("model", or empty for
/// a file that is nothing else). What does not fit together is added to `errors`.
StatedAxis ToStatedAxis(const LooseAxisFile& file, const YamlValue& tree, const std::string& model_key,
                        std::vector<std::string>& errors);

}  // namespace contour::diagnosis
