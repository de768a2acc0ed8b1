#pragma once

#include <string>
#include <vector>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/axis_model/stated_axis_config.h"
#include "config/machine_config.h"
#include "config/yaml_tree.h"

namespace contour::diagnosis {

/// Reads the model of one axis, strictly, from a machine file (`axis` may be empty when it has one axis
/// only), or from a file with a model alone: the keys of a model, or `model:` and `drive:`
/// (docs/diagnosis_files.md). Throws ConfigError with all that is wrong.
StatedAxis ReadStatedAxis(const std::string& file, const std::string& axis,
                          const std::vector<std::string>& overrides = {});

/// Such a file as it stands; its tree gets the keys of ExtensionsConfig. Throws ConfigError with all that is
/// wrong.
LooseAxisFile ReadLooseFile(YamlValue& tree);

/// Whether the file is a whole machine file.
bool IsMachineFile(const std::string& file);

/// The same from a machine file that is read already.
StatedAxis ToStatedAxis(const MachineConfig& machine, const std::string& axis);

}  // namespace contour::diagnosis
