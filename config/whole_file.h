#pragma once

#include <filesystem>
#include <string_view>

namespace contour {

/// Writes `text` as `file`: either all of it stands there, and outlives a power failure, or what stood there
/// before. A name that leads elsewhere is followed, also to where nothing is yet; owner and permissions of a
/// file that is there stay. Written over, so that half of it can be left, are files that no other can take
/// the place of: what is no regular file (/dev/null, a pipe), one with several names (hard links), one in a
/// directory that takes no new file, one that something is mounted on, one whose owner cannot be kept. A
/// process that is killed can leave FILE.PID.N.new. Throws std::runtime_error with the file and the reason,
/// also for a file that may not be written to.
void WriteWholeFile(const std::filesystem::path& file, std::string_view text);

}  // namespace contour
