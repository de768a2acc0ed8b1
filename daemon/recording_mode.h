#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/new_start.h"

namespace contour {

// Another mode for a while, whatever the machine file says. Commissioning asks for torque mode where drives
// close their own loops, since a force that is sent is known better than one that a drive reports; and for
// csp where no loop from here can hold an axis of which only a catalogue is known.

/// Assignments that put every axis into the mode; none for the machine file's own. Throws ConfigError at what
/// is not an axis and its keys.
std::vector<std::string> RecordingOverrides(const RecordingMode& mode);

/// What an operator is told for as long as it lasts; nothing in the machine file's own mode. Who asked for it
/// may be gone without having given it back.
std::optional<std::string> RecordingModeText(const RecordingMode& mode);

/// Assignments less those of RecordingOverrides(), which came last of their kind: what is left is the
/// operator's own.
std::vector<std::string> WithoutRecordingMode(const RecordingMode& mode, std::vector<std::string> overrides);

}  // namespace contour
