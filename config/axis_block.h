#pragma once

#include <string>

namespace contour {

/// The text of a machine file with `axes.<axis>.<key>` set to `block` (the map below it, as WriteYaml gives
/// it). What else there is, comments included, stays as it was. Throws ConfigError when the axis is not
/// written over several lines, or when `name` (the file, for messages) is no machine file.
std::string WithAxisBlock(const std::string& text, const std::string& name, const std::string& axis,
                          const std::string& key, const std::string& block);

}  // namespace contour
