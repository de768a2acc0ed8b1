#include "config/load_machine.h"

#include <filesystem>
#include <utility>

#include "config/config_error.h"
#include "config/machine_checks.h"
#include "config/yaml_reader.h"

namespace contour {
namespace {

// A model file holds the keys of a model, or one key `model` with them below.
YamlValue ModelOfFile(const std::string& path) {
  YamlValue root = ParseYamlFile(path);
  if (root.entries.size() == 1 && root.entries.front().key == "model") {
    YamlValue model = std::move(root.entries.front().value);
    return model;
  }
  return root;
}

// `model: some_file.yaml`, relative to the machine file.
void PlaceModelFiles(YamlValue& root, const std::string& path) {
  YamlEntry* axes = root.Find("axes");
  if (axes == nullptr) return;
  for (YamlEntry& axis : axes->value.entries) {
    YamlEntry* model = axis.value.Find("model");
    if (model == nullptr || model->value.kind != YamlValue::Kind::kScalar) continue;
    const std::filesystem::path file = std::filesystem::path(path).parent_path() / model->value.text;
    try {
      model->value = ModelOfFile(file.string());
    } catch (const ConfigError& e) {
      throw ConfigError({model->where + ": axes." + axis.key + ".model: " + e.what()});
    }
  }
}

}  // namespace

YamlValue OpenMachineFile(const std::string& path, const std::vector<std::string>& overrides) {
  YamlValue tree = ParseYamlFile(path);
  // Twice: a model named on the command line, and values put on top of a model that came from a file.
  PlaceModelFiles(tree, path);
  for (const std::string& assignment : overrides) {
    ApplyOverride(tree, assignment);
    PlaceModelFiles(tree, path);
  }
  return tree;
}

MachineConfig ReadMachine(const YamlValue& tree, std::vector<std::string>& errors) {
  YamlValue without_emulator = tree;
  std::erase_if(without_emulator.entries, [](const YamlEntry& e) { return e.key == "emulator"; });
  MachineConfig config;
  const std::size_t before = errors.size();
  ReadYaml(without_emulator, config, "", errors);
  if (errors.size() != before) return config;
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
  YamlValue tree = ModelOfFile(path);
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
