#pragma once

#include <string>
#include <vector>

#include "daemon/new_start.h"
#include "daemon/options.h"

namespace contour {

/// Log and truth go on in files of their own.
DaemonOptions WithNewStart(DaemonOptions options, const NewStart& start);

/// The options with another model of an axis, AXIS=YAML; `AXIS=` takes away what was loaded before.
DaemonOptions WithModel(DaemonOptions options, const std::string& model);

/// "with another model of axis x"
std::string Describe(const NewStart& start);

/// The command line that these options come from.
std::vector<std::string> ArgumentsOf(const DaemonOptions& options);

/// The first of FILE.1, FILE.2, ... that is not there; after FILE.2 comes FILE.3. Empty stays empty.
std::string NextFile(const std::string& file);

/// contourd from its beginning, in this process. Throws EnvironmentError when the kernel refuses.
[[noreturn]] void StartAgain(const DaemonOptions& options);

}  // namespace contour
