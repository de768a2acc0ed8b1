#pragma once

#include <string>
#include <vector>

#include "config/yaml_tree.h"

namespace contour {

/// Turns a contest's assignments into those that --set takes: `.axes.*.` (or `axes.*.` at the beginning)
/// becomes one assignment per axis of the file, and KEY*=FACTOR becomes KEY=VALUE with the file's value times
/// the factor. Throws ConfigError when such a key is missing in the file or is no number.
std::vector<std::string> ExpandAssignments(const YamlValue& machine_file,
                                           const std::vector<std::string>& assignments);

/// The number at a dotted key of the file; throws ConfigError when there is none.
double NumberAt(const YamlValue& machine_file, const std::string& dotted_key);

}  // namespace contour
