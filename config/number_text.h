#pragma once

#include <string>

#include "core/visit.h"

namespace contour {

/// Shortest text that reads back as the same double.
std::string NumberText(double number);

/// A number for people: four significant digits, no powers of ten where they can be done without.
std::string RoundedText(double number);

/// " above 0", " from 0.1 to 200", " of at least 0", or nothing.
std::string RangeText(const Range& range);

}  // namespace contour
