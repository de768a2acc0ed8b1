#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/drive_loop/drive_record.h"
#include "config/machine_config.h"

namespace contour {

/// What the motions of DriveMotions say of the loop that the axis's drive closes: printed, with advice, and
/// written to `file` as JSON with the measured response. Gives the exit status; 1, and nothing written, when
/// it says nothing.
int ReportOnDrive(const MachineConfig& machine, const std::string& axis,
                  const std::vector<DriveSample>& samples, const std::filesystem::path& file);

}  // namespace contour
