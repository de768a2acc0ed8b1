#pragma once

#include <filesystem>
#include <string>

namespace contour {

/// Has a script of tools/plots draw what is in a directory; where this program lives outside of its source
/// tree, says how to.
void DrawPictures(const std::string& name, const std::filesystem::path& directory);

}  // namespace contour
