#pragma once

#include <string_view>

namespace contour {

/// Version of the programs, from CMakeLists.txt.
inline constexpr std::string_view kVersion = CONTOUR_VERSION;

}  // namespace contour
