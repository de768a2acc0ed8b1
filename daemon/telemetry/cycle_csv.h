#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/cycle_record.h"

namespace contour {

/// The table of cycles: cycles.csv of `contour simulate` and `contour run --out`, and `contour export`.
///
/// One row per cycle. Angle, position, reference and estimate of a row belong to the same instant, `time_s`,
/// the SYNC that latched the feedback; the torque of the row was computed from them and begins to act one
/// cycle later (what diagnosis calls delay_cycles: 1). time_s counts grid points: it is 0 at the sample that
/// cycle 1 works on. Numbers are the shortest text that reads back as the same value, whatever the locale; a
/// quantity that does not exist (no linear scale, no temperature sensor) is an empty field.
class CycleCsv {
 public:
  /// `columns`: only these, in this order; none for all. Throws std::invalid_argument for a name that is
  /// none.
  CycleCsv(std::span<const std::string> axis_names, int cycle_us, std::span<const std::string> columns = {});

  /// The header line, with its line end.
  [[nodiscard]] std::string Header() const;

  /// Appends one line. Timing is all zero in virtual time.
  void AppendRow(const CycleRecord& record, const CycleTiming& timing, std::string& out) const;

 private:
  static constexpr std::size_t kNoAxis = ~std::size_t{0};
  struct Column {
    std::string name;
    std::size_t axis = kNoAxis;
    std::size_t index = 0;  ///< among those of a cycle, or of an axis
  };

  std::vector<Column> columns_;
  int cycle_us_;
};

}  // namespace contour
