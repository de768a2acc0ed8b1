#include "config/config_difference.h"

#include <map>

#include "config/yaml_tree.h"
#include "config/yaml_writer.h"

namespace contour {
namespace {

using Leaf = std::pair<std::string, std::string>;

std::string TextOf(const YamlValue& value) {
  if (value.kind == YamlValue::Kind::kScalar) return value.text;
  const bool map = value.kind == YamlValue::Kind::kMap;
  std::string text = map ? "{" : "[";
  for (const YamlEntry& e : value.entries)
    text += (text.size() > 1 ? ", " : "") + e.key + ": " + TextOf(e.value);
  for (const YamlValue& item : value.items) text += (text.size() > 1 ? ", " : "") + TextOf(item);
  return text + (map ? "}" : "]");
}

void Flatten(const YamlValue& value, const std::string& path, std::vector<Leaf>& leaves) {
  if (value.kind == YamlValue::Kind::kMap) {
    for (const YamlEntry& entry : value.entries)
      Flatten(entry.value, path.empty() ? entry.key : path + "." + entry.key, leaves);
  } else if (value.kind != YamlValue::Kind::kNull) {
    leaves.emplace_back(path, TextOf(value));
  }
}

std::vector<Leaf> Leaves(MachineConfig config) {
  std::string text;
  YamlWriter writer(text);
  config.Visit(writer);
  std::vector<Leaf> leaves;
  Flatten(ParseYamlText(text, "configuration"), "", leaves);
  return leaves;
}

}  // namespace

std::vector<ConfigDifference> Differences(const MachineConfig& was, const MachineConfig& now) {
  const std::vector<Leaf> before = Leaves(was);
  std::map<std::string, std::string> after;
  std::vector<ConfigDifference> differences;
  for (const auto& [key, value] : Leaves(now)) after[key] = value;
  for (const auto& [key, value] : before) {
    const auto other = after.find(key);
    const std::string text = other == after.end() ? std::string() : other->second;
    if (text != value) differences.push_back({key, value, text});
    if (other != after.end()) after.erase(other);
  }
  for (const auto& [key, value] : after) differences.push_back({key, {}, value});
  return differences;
}

bool MayChangeWhileRunning(const std::string& key) {
  if (!key.starts_with("control.")) return false;
  // The guard is no gain; horizons and whether there is a planner decide what memory there is.
  return !key.starts_with("control.guard.") && !key.starts_with("control.monitor.") &&
         !key.starts_with("control.supervision.") && !key.starts_with("control.csp.") &&
         !key.ends_with(".horizon") && key != "control.planner.enabled";
}

}  // namespace contour
