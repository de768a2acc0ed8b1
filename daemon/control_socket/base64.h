#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace contour {

/// RFC 4648, section 4, with padding.
std::string ToBase64(std::string_view bytes);
/// Nothing when the text is not that.
std::optional<std::string> FromBase64(std::string_view text);

}  // namespace contour
