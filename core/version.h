#pragma once

#include <string>
#include <string_view>

namespace contour {

/// Version of the programs, from CMakeLists.txt.
inline constexpr std::string_view kVersion = CONTOUR_VERSION;

/// Version, compiler and kind of build: what must agree for a recorded run to come out bit for bit.
inline std::string BuildIdentity() {
  return "contourd " + std::string(kVersion) + ", " + __VERSION__ +
#ifdef __OPTIMIZE__
         ", optimised";
#else
         ", not optimised";
#endif
}

}  // namespace contour
