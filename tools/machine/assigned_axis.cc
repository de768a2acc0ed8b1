#include "tools/machine/assigned_axis.h"

#include "config/config_error.h"
#include "config/yaml_reader.h"
#include "config/yaml_tree.h"
#include "config/yaml_writer.h"

namespace contour {

EmulatedAxisConfig Assigned(const EmulatedAxisConfig& axis, const std::vector<std::string>& assignments) {
  if (assignments.empty()) return axis;
  YamlValue tree = ParseYamlText(WriteYaml(axis), "emulated axis");
  for (const std::string& assignment : assignments) ApplyOverride(tree, assignment);
  EmulatedAxisConfig out;
  std::vector<std::string> errors;
  ReadYaml(tree, out, "", errors);
  if (!errors.empty()) throw ConfigError(errors);
  return out;
}

}  // namespace contour
