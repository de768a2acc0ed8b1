#pragma once

#include <filesystem>
#include <string_view>

namespace contour {

/// Writes `text` as `file`: either all of it stands there, and outlives a power failure, or what stood there
/// before. A name that leads elsewhere is followed; owner and permissions of a file that is there stay. What
/// is no regular file (/dev/null, a pipe) is written to as it is, and so is a file in a directory that takes
/// no new one, or one whose owner cannot be kept. Throws std::runtime_error with the file and the reason.
void WriteWholeFile(const std::filesystem::path& file, std::string_view text);

}  // namespace contour
