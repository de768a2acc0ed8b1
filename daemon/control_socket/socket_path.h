#pragma once

#include <filesystem>

namespace contour {

/// Where the daemon makes its socket unless told otherwise, and where its companions look for it:
/// CONTOUR_SOCKET when that is set; else contourd/control.sock in the directory that systemd gave
/// (RUNTIME_DIRECTORY: control.sock right there), in /run for root, in XDG_RUNTIME_DIR for everybody else, in
/// /tmp/contourd-UID when there is none. A companion that has no directory of its own finds a service's
/// socket in /run.
std::filesystem::path DefaultSocketPath();

}  // namespace contour
