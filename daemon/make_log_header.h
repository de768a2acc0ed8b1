#pragma once

#include <cstdint>
#include <string>

#include "config/load_machine.h"
#include "daemon/telemetry/log_header.h"

namespace contour {

/// What a log says of a run of this machine: the configuration as it was read, and the build that runs it.
LogHeader MakeLogHeader(const MachineSource& source, const MachineConfig& machine, const std::string& clock,
                        std::int64_t start_unix_us);

/// The machine file as a log keeps it.
MachineSource SourceOf(const LogHeader& header);

}  // namespace contour
