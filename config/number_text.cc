#include "config/number_text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace contour {

std::string NumberText(double number) {
  std::array<char, 40> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), number);
  return {text.data(), result.ptr};
}

std::string RoundedText(double number) {
  std::array<char, 40> text{};
  const bool large = std::abs(number) >= 1e3 && std::abs(number) < 1e9;
  std::snprintf(text.data(), text.size(), large ? "%.0f" : "%.4g", number);
  return text.data();
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
