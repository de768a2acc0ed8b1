#include "tools/faults/machine_in_mode.h"

#include <utility>
#include <vector>

#include "config/config_error.h"

namespace contour::faults {

EmulatedMachineFile MachineInMode(const std::string& path, const EmulatedMachineFile& as_stated,
                                  DriveMode mode) {
  const std::string name(Name(mode));
  std::vector<std::string> assignments;
  for (const auto& [axis, config] : as_stated.machine.axes)
    assignments.push_back("axes." + axis + ".drive.mode=" + name);
  try {
    return LoadEmulatedMachine(path, assignments);
  } catch (const ConfigError& e) {
    std::vector<std::string> errors = e.messages();
    const std::string other(Name(mode == DriveMode::kCst ? DriveMode::kCsp : DriveMode::kCst));
    errors.push_back("that is with all drives in " + name + "; without these runs: --mode " + other);
    throw ConfigError(std::move(errors));
  }
}

}  // namespace contour::faults
