#pragma once

#include <string>

#include "config/yaml_tree.h"

// Extensions are stated at a motor, in Nm and rad, and along a table, in mm. On a linear axis the same keys
// are in N and m, and say so; along an axis without a lead they are in mrad.
namespace contour::diagnosis {

enum class ExtensionUnits { kOfScrew, kOfLinearAxis, kOfTurningAxis };

/// Units of a model alone: what it states tells.
ExtensionUnits UnitsOf(const YamlValue& model);

/// Keys of the file become those of ExtensionsConfig; keys of other units become unknown ones.
void RenameFromFile(ExtensionUnits units, YamlValue& extensions);
/// The same back, of YAML text or a message.
std::string RenamedToFile(ExtensionUnits units, std::string text);

}  // namespace contour::diagnosis
