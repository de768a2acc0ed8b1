#pragma once

#include <string>
#include <vector>

namespace contour {

// A model that contourd was handed while it ran, AXIS=YAML: it stands in place of the machine file's.

/// As `--set` has it.
std::string ModelOverride(const std::string& model);

/// What operators are told of such models, one sentence for each axis.
std::vector<std::string> LoadedModelTexts(const std::vector<std::string>& models);

/// Assignments less those that put a model, or a part of one, in place of an axis's own.
std::vector<std::string> WithoutModelOf(const std::string& axis, std::vector<std::string> overrides);

}  // namespace contour
