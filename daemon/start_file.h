#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/options.h"
#include "tools/machine/load_emulated_machine.h"

namespace contour {

/// The command line as assignments on top of the machine file.
std::vector<std::string> OverridesOf(const DaemonOptions& options);

/// The machine file as `overrides` change it; of a real bus without its `emulator:`.
MaybeEmulatedMachineFile LoadFile(const DaemonOptions& options, const std::vector<std::string>& overrides);

/// Loops judged before anything moves.
struct StartLoops {
  std::vector<std::string> chosen;  ///< as assignments, where the file has none
  std::vector<std::string> warned;  ///< of loops that break a limit and run all the same
};
/// For a start with this command line; `overrides` are OverridesOf() it. Throws ConfigError where a loop is
/// unstable on the axis as stated or on its uncertainty set and is none to commission with. Loops that
/// commission hands in (`--torque-loop`) it has judged on what a catalogue leaves open: they are refused only
/// where they are unstable on the axis as stated. What breaks another limit of `contour check` is warned of.
/// `begins`: LoopsThatAreMissing.
StartLoops LoopsOfStart(const DaemonOptions& options, const std::vector<std::string>& overrides,
                        const std::function<void()>& begins = nullptr);

/// The same of a machine that is to run as `overrides` state it whole. Returns what is to be warned of.
std::vector<std::string> RequireLoops(const DaemonOptions& options,
                                      const std::vector<std::string>& overrides);

}  // namespace contour
