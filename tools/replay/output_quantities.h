#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/cycle_record.h"

namespace contour {

/// Something that a cycle gives out: a measure, compared with a tolerance; or a whole number, state or frame,
/// which is the same or is not.
using OutputValue = std::variant<double, std::int64_t, std::string>;

/// Everything a cycle gives out, by name: of the machine, then of each axis with its name in front, as the
/// columns of cycles.csv are named; then the frames.
class OutputQuantities {
 public:
  explicit OutputQuantities(std::span<const std::string> axis_names);

  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }
  /// One value for each name.
  void Values(const CycleOutput& output, std::vector<OutputValue>& values) const;

 private:
  std::size_t axes_;
  std::vector<std::string> names_;
};

/// Equal to the last bit; a NaN equals the same NaN.
bool Identical(const OutputValue& a, const OutputValue& b);
/// For people; doubles as the shortest text that reads back as the same value.
std::string Text(const OutputValue& value);

}  // namespace contour
