#pragma once

#include <string>

namespace contour {

/// What printf would print, however long it is.
[[gnu::format(printf, 1, 2)]] std::string FormatText(const char* format, ...);

}  // namespace contour
