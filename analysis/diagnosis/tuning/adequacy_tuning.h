#pragma once

namespace contour::diagnosis {

/// Whether something is left that no cause explains.
struct AdequacyTuning {
  /// [s] Of a bin of time. Source: reasoning. 2026-11-22
  double time_bin_s = 1.0;
};

inline constexpr AdequacyTuning kAdequacy;

}  // namespace contour::diagnosis
