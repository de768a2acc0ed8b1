#pragma once

#include <functional>

#include "core/exit_status.h"

// How to add a subcommand NAME:
//   1. NAME_command.h declares `void AddNameCommand(CLI::App& app, Action& action);`
//   2. NAME_command.cc defines it: app.add_subcommand, its options into a struct held by shared_ptr, and
//      sub->callback([options, &action] { action = [options] { return RunName(*options); }; });
//   3. main.cc calls it, CMakeLists.txt lists the source and what it links.
// RunName returns an ExitStatus, or throws: ConfigError becomes status 2, EnvironmentError 3, anything else
// 1, with its message on stderr. --help and --version come by themselves.
namespace contour {

/// What the chosen subcommand does once the command line is known to be good; returns the exit status.
using Action = std::function<int()>;

}  // namespace contour
