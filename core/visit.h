#pragma once

#include <limits>
#include <string_view>

namespace contour {

/// Bounds of a configuration value, inclusive; the type of the value decides what else is checked.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_excluded = false;
};
inline constexpr Range kAny{};
inline constexpr Range kPositive{0.0, std::numeric_limits<double>::infinity(), true};
inline constexpr Range kNotNegative{0.0, std::numeric_limits<double>::infinity(), false};

// A configuration struct lists its fields once:
//
//   struct ScrewConfig {
//     double lead_mm = 0;
//     double backlash_um = 0;
//     template <class Visitor> void Visit(Visitor& v) {
//       v.Required("lead_mm", lead_mm, Range{0.1, 200}, "travel of the table per motor turn");
//       v.Optional("backlash_um", backlash_um, kNotNegative, "play of the nut");   // default: the member's
//       initialiser
//     }
//   };
//
// The strict YAML reader, the reference table of `contour check --describe` and the log header use the same
// list. Members may be double, integers, bool, std::string, std::array<double, 2>, std::vector<double>,
// nested structs with Visit (no Range argument then: v.Required("drive", drive, "the drive of this axis")),
// std::optional of those, std::map<std::string, Struct>, and enums that have `bool FromName(std::string_view,
// Enum&)`, `std::string_view Name(Enum)` and `std::string_view Choices(Enum)` found by argument-dependent
// look-up.

}  // namespace contour
