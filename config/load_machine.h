#pragma once

#include <map>
#include <string>
#include <vector>

#include "config/machine_config.h"
#include "config/yaml_tree.h"

namespace contour {

/// Reads and checks a machine file (strictly; machine_checks.h says what must fit together). Whatever stands
/// under `emulator:` is left alone. `overrides` are assignments as `--set` takes them:
/// "machine.cycle_us=2000". Throws ConfigError with all that is wrong.
MachineConfig LoadMachine(const std::string& path, const std::vector<std::string>& overrides = {});

/// A machine file as it was read, with all that is needed to read it again elsewhere.
struct MachineSource {
  std::string name;                          ///< of the file
  std::string text;                          ///< the file itself
  std::map<std::string, std::string> files;  ///< further files by the names that it has for them
  std::vector<std::string> overrides;        ///< as above
};
MachineSource ReadSource(const std::string& path, const std::vector<std::string>& overrides);
/// The same MachineConfig as LoadMachine of the file.
MachineConfig LoadMachine(const MachineSource& source);

/// Reads a model that stands alone: the keys of `axes.<name>.model` at the top of the file, or under
/// `model:`.
ModelConfig LoadModel(const std::string& path, const std::vector<std::string>& overrides = {});

// The steps of LoadMachine, for a reader that wants more of the same file.

/// The tree of a machine file, models named by file put in place, overrides applied.
YamlValue OpenMachineFile(const std::string& path, const std::vector<std::string>& overrides);

/// Everything but `emulator:`; errors of reading or, when there are none, of the checks are added to
/// `errors`.
MachineConfig ReadMachine(const YamlValue& tree, std::vector<std::string>& errors);

}  // namespace contour
