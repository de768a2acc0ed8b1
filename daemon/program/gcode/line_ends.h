#pragma once

#include <cstddef>
#include <string_view>

namespace contour {

/// Editors of Windows put it before the first line of UTF-8.
constexpr std::string_view WithoutByteOrderMark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

/// Where a line's text ends, and where the next line begins.
struct LineEnd {
  std::size_t text = 0;
  std::size_t next = 0;
};

/// A line ends with LF, CR or both of them, CR first; the last one with the text, too.
constexpr LineEnd EndOfLineFrom(std::string_view text, std::size_t at) {
  const std::size_t end = text.find_first_of("\r\n", at);
  if (end == std::string_view::npos) return {text.size(), text.size()};
  const bool both = text[end] == '\r' && end + 1 < text.size() && text[end + 1] == '\n';
  return {end, end + (both ? 2 : 1)};
}

}  // namespace contour
