#include "config/number_text.h"

#include <array>
#include <charconv>
#include <cmath>

namespace contour {

std::string NumberText(double number) {
  std::array<char, 40> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), number);
  return {text.data(), result.ptr};
}

std::string RangeText(const Range& range) {
  const bool lower = std::isfinite(range.min);
  const bool upper = std::isfinite(range.max);
  if (!lower && !upper) return "";
  if (!upper) return (range.min_excluded ? " above " : " of at least ") + NumberText(range.min);
  if (!lower) return " of at most " + NumberText(range.max);
  return (range.min_excluded ? " above " : " from ") + NumberText(range.min) +
         (range.min_excluded ? " up to " : " to ") + NumberText(range.max);
}

}  // namespace contour
