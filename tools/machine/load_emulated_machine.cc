#include "tools/machine/load_emulated_machine.h"

#include <utility>

#include "config/config_error.h"
#include "config/load_machine.h"
#include "config/yaml_reader.h"
#include "design/loop_choice.h"
#include "design/path_following.h"

namespace contour {
namespace {

void CheckAxes(const YamlValue& tree, const MaybeEmulatedMachineFile& file,
               std::vector<std::string>& errors) {
  for (const auto& [name, axis] : file.machine.axes)
    if (!file.emulator.axes.contains(name))
      errors.push_back(WhereIs(tree, "emulator.axes") + ": emulator.axes." + name +
                       ": missing, expected the emulated machine of axis '" + name + "'");
  for (const auto& [name, axis] : file.emulator.axes)
    if (!file.machine.axes.contains(name))
      errors.push_back(WhereIs(tree, "emulator.axes." + name) + ": emulator.axes." + name +
                       ": found an axis that the machine does not have");
}

}  // namespace

MaybeEmulatedMachineFile LoadMaybeEmulatedMachine(const std::string& path,
                                                  const std::vector<std::string>& overrides) {
  const YamlValue tree = OpenMachineFile(path, overrides);
  std::vector<std::string> errors;
  MaybeEmulatedMachineFile file;
  file.machine = ReadMachine(tree, errors);
  if (const YamlEntry* section = tree.Find("emulator")) {
    file.has_emulator = true;
    const std::size_t before = errors.size();
    ReadYaml(section->value, file.emulator, "emulator", errors);
    if (errors.size() == before) CheckAxes(tree, file, errors);
  }
  if (!errors.empty()) throw ConfigError(std::move(errors));
  return file;
}

EmulatedMachineFile LoadEmulatedMachine(const std::string& path, const std::vector<std::string>& overrides,
                                        std::optional<ControllerName> runs) {
  MaybeEmulatedMachineFile file = LoadMaybeEmulatedMachine(path, overrides);
  MachineConfig run = file.machine;
  run.machine.controller = runs.value_or(file.machine.machine.controller);
  std::vector<std::string> with_loops = LoopsThatAreMissing(run, path);
  if (!with_loops.empty()) {
    with_loops.insert(with_loops.begin(), overrides.begin(), overrides.end());
    file = LoadMaybeEmulatedMachine(path, with_loops);
  }
  if (!file.machine.machine.path_following_mm)
    file.machine.machine.path_following_mm = ExpectedFollowing_mm(file.machine);
  if (!file.has_emulator)
    throw ConfigError({path + ": emulator: missing, expected a map of keys: the machine to emulate"});
  return {std::move(file.machine), std::move(file.emulator)};
}

}  // namespace contour
