#include "config/load_machine.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <utility>

#include "config/config_error.h"
#include "config/friction_choice.h"
#include "config/machine_checks.h"
#include "config/yaml_reader.h"

namespace contour {
namespace {

/// Identification and diagnosis know axes that no controller here has.
void RefuseOtherAxes(const YamlValue& model) {
  if (const YamlEntry* mass = model.Find("mass_kg"))
    throw ConfigError({mass->where +
                       ": mass_kg: states a linear axis, expected one with a ball screw: lead_mm, "
                       "motor_inertia_kgm2, table_mass_kg, screw_stiffness_N_um"});
  const YamlEntry* inertia = model.Find("motor_inertia_kgm2");
  if (inertia == nullptr) return;
  for (const char* key : {"lead_mm", "screw_stiffness_N_um"})
    if (model.Find(key) == nullptr)
      throw ConfigError({inertia->where + ": motor_inertia_kgm2: states an axis without " + key +
                         ", expected one with a ball screw: lead_mm, motor_inertia_kgm2, table_mass_kg, "
                         "screw_stiffness_N_um"});
}

// A file of a model or a loop holds its keys, or one key `model` or `loop` with them below; a model may have
// `drive` beside it, which is the machine file's matter.
YamlValue Below(const std::string& key, YamlValue root) {
  const auto is = [&](const YamlEntry& e) { return e.key == key || (key == "model" && e.key == "drive"); };
  YamlEntry* entry = root.Find(key);
  if (entry != nullptr && std::all_of(root.entries.begin(), root.entries.end(), is)) {
    YamlValue below = std::move(entry->value);
    root = std::move(below);
  }
  if (key == "model") RefuseOtherAxes(root);
  return root;
}

/// Gives a file that a machine file names, as it names it.
using OpenNamed = std::function<YamlValue(const std::string& name)>;

// `model: some_file.yaml` and `loop: some_file.yaml`, relative to the machine file.
void PlaceFiles(YamlValue& root, const OpenNamed& open) {
  YamlEntry* axes = root.Find("axes");
  if (axes == nullptr) return;
  for (YamlEntry& axis : axes->value.entries) {
    for (const std::string key : {"model", "loop"}) {
      YamlEntry* entry = axis.value.Find(key);
      if (entry == nullptr || entry->value.kind != YamlValue::Kind::kScalar) continue;
      try {
        entry->value = Below(key, open(entry->value.text));
      } catch (const ConfigError& e) {
        throw ConfigError({entry->where + ": axes." + axis.key + "." + key + ": " + e.what()});
      }
    }
  }
}

YamlValue Assemble(YamlValue tree, const std::vector<std::string>& overrides, const OpenNamed& open) {
  // Twice: a model named on the command line, and values put on top of a model that came from a file.
  PlaceFiles(tree, open);
  for (const std::string& assignment : overrides) {
    ApplyOverride(tree, assignment);
    PlaceFiles(tree, open);
  }
  return tree;
}

std::string Beside(const std::string& path, const std::string& name) {
  return (std::filesystem::path(path).parent_path() / name).string();
}

}  // namespace

YamlValue OpenMachineFile(const std::string& path, const std::vector<std::string>& overrides) {
  return Assemble(ParseYamlFile(path), overrides,
                  [&](const std::string& name) { return ParseYamlFile(Beside(path, name)); });
}

MachineSource ReadSource(const std::string& path, const std::vector<std::string>& overrides) {
  MachineSource source{path, ReadTextFile(path), {}, overrides};
  Assemble(ParseYamlText(source.text, path), overrides, [&](const std::string& name) {
    const std::string text = ReadTextFile(Beside(path, name));
    source.files[name] = text;
    return ParseYamlText(text, name);
  });
  return source;
}

MachineConfig LoadMachine(const MachineSource& source) {
  const YamlValue tree =
      Assemble(ParseYamlText(source.text, source.name), source.overrides, [&](const std::string& name) {
        const auto file = source.files.find(name);
        if (file == source.files.end()) throw ConfigError({name + ": is not kept with " + source.name});
        return ParseYamlText(file->second, name);
      });
  std::vector<std::string> errors;
  MachineConfig config = ReadMachine(tree, errors);
  if (!errors.empty()) throw ConfigError(std::move(errors));
  return config;
}

MachineConfig ReadMachine(const YamlValue& tree, std::vector<std::string>& errors) {
  YamlValue without_emulator = tree;
  std::erase_if(without_emulator.entries, [](const YamlEntry& e) { return e.key == "emulator"; });
  MachineConfig config;
  const std::size_t before = errors.size();
  ReadYaml(without_emulator, config, "", errors);
  if (errors.size() != before) return config;
  if (std::string& table = config.machine.tool_table; !table.empty())
    table = std::filesystem::absolute(Beside(tree.where, table)).lexically_normal().string();
  const YamlEntry* control = without_emulator.Find("control");
  config.control.friction_stated = control != nullptr && control->value.Find("friction") != nullptr;
  if (!config.control.friction_stated) config.control.friction = ChooseFriction(config);
  for (const ConfigProblem& p : Check(config))
    errors.push_back(WhereIs(without_emulator, p.key) + ": " + p.key + ": " + p.message);
  return config;
}

MachineConfig LoadMachine(const std::string& path, const std::vector<std::string>& overrides) {
  std::vector<std::string> errors;
  MachineConfig config = ReadMachine(OpenMachineFile(path, overrides), errors);
  if (!errors.empty()) throw ConfigError(std::move(errors));
  return config;
}

ModelConfig LoadModel(const std::string& path, const std::vector<std::string>& overrides) {
  YamlValue tree = Below("model", ParseYamlFile(path));
  for (const std::string& assignment : overrides) ApplyOverride(tree, assignment);
  std::vector<std::string> errors;
  ModelConfig model;
  ReadYaml(tree, model, "", errors);
  if (errors.empty())
    for (const ConfigProblem& p : Check(model, ""))
      errors.push_back(WhereIs(tree, p.key) + ": " + p.key + ": " + p.message);
  if (!errors.empty()) throw ConfigError(std::move(errors));
  return model;
}

}  // namespace contour
