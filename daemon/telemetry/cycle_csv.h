#pragma once

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
  CycleCsv(std::span<const std::string> axis_names, int cycle_us);

  /// The header line, with its line end.
  [[nodiscard]] std::string Header() const;

  /// Appends one line. Timing is all zero in virtual time.
  void AppendRow(const CycleRecord& record, const CycleTiming& timing, std::string& out) const;

 private:
  std::vector<std::string> axis_names_;
  int cycle_us_;
};

}  // namespace contour
