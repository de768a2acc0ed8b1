#pragma once

#include <string>
#include <vector>

#include "config/yaml_tree.h"
#include "tools/diagnosis/files/stated_axis_config.h"
#include "tools/diagnosis/stated_axis.h"

namespace contour::diagnosis {

/// The axis that a model alone states. `model_key` is where the model stands in `tree` ("model", or empty for
/// a file that is nothing else). What does not fit together is added to `errors`.
StatedAxis ToStatedAxis(const LooseAxisFile& file, const YamlValue& tree, const std::string& model_key,
                        std::vector<std::string>& errors);

}  // namespace contour::diagnosis
