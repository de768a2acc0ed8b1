#pragma once

#include <string>
#include <vector>

namespace contour {

/// Key of a log note that tells of changed gains: this and the number of the change. Its text is a KEY=VALUE
/// on each line.
inline constexpr const char* kTuningNote = "tuning ";

inline std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    lines.push_back(text.substr(at, end - at));
    if (end == std::string::npos) break;
    at = end + 1;
  }
  return lines;
}

}  // namespace contour
