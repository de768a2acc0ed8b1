#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace contour {

/// The status for people: what `contour status` prints.
std::string StatusText(const nlohmann::json& status);

/// Of the program: "program part.ngc line 12, 3.2 of 12.4 s, 9.2 s left, feed 50 %, paused, contour error
/// 0.31 um"; empty when there was none yet.
std::string ProgramText(const nlohmann::json& status);

/// One line of it, for `contour watch`.
std::string StatusLine(const nlohmann::json& status);

}  // namespace contour
