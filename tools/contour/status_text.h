#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace contour {

/// The status for people: what `contour status` prints.
std::string StatusText(const nlohmann::json& status);

/// One line of it, for `contour watch`.
std::string StatusLine(const nlohmann::json& status);

}  // namespace contour
