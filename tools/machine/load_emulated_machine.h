#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/machine_config.h"
#include "tools/plant_emulator/emulator_config.h"

namespace contour {

/// A machine file with its section `emulator:`.
struct EmulatedMachineFile {
  MachineConfig machine;
  EmulatorConfig emulator;
};

/// Reads and checks everything. `machine` is what LoadMachine gives, with what is chosen where the file says
/// nothing: loops, and machine.path_following_mm. Throws ConfigError with all that
/// is wrong; a file without `emulator:`, or one that emulates other axes than `axes:` has, is wrong here.
/// `runs`: the controller that is going to run, where it is not the file's: loops are chosen where it needs
/// them.
EmulatedMachineFile LoadEmulatedMachine(const std::string& path,
                                        const std::vector<std::string>& overrides = {},
                                        std::optional<ControllerName> runs = {});

/// A machine file whose `emulator:` may be missing (a real machine's).
struct MaybeEmulatedMachineFile {
  MachineConfig machine;
  bool has_emulator = false;
  EmulatorConfig emulator;
};
MaybeEmulatedMachineFile LoadMaybeEmulatedMachine(const std::string& path,
                                                  const std::vector<std::string>& overrides = {});

}  // namespace contour
