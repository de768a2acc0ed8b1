#pragma once

#include <cstddef>

namespace contour::diagnosis {

/// A wrong reading lasts for so many rows at most; what lasts longer goes on.
inline constexpr std::size_t kOutlierRows = 3;

}  // namespace contour::diagnosis
