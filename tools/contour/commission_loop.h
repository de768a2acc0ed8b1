#pragma once

#include <filesystem>
#include <string>

#include "config/machine_config.h"

namespace contour {

/// The loop of the axis with the model that commissioning found, printed with its margins and written to
/// `file`, whole or not at all. Nothing is written where there is none that keeps its limits; then it is said
/// what would help. `interrupted`, where there is one: what SIGINT and SIGTERM end the process with while it
/// searches (EndsAtOnce), not while it writes.
void FindAndWriteLoop(const MachineConfig& machine, const std::string& axis, const ModelConfig& model,
                      const std::filesystem::path& file, const char* interrupted);

/// The same for a model that came to an axis with a loop, where that does not keep its limits with it; else
/// nothing.
void FindLoopWhereItIsNoLongerGood(const MachineConfig& machine, const std::string& axis,
                                   const ModelConfig& model, const std::filesystem::path& file);

}  // namespace contour
