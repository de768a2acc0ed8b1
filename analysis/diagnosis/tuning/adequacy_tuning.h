#pragma once

#include <cstddef>

namespace contour::diagnosis {

/// Whether something is left that no cause explains.
struct AdequacyTuning {
  /// [rows] That a pulse is followed for. Source: reasoning; 64 ms at 1 kHz. 2026-11-22
  std::size_t response_rows = 64;
  /// [rows] A bin with fewer says nothing. Source: reasoning. 2026-11-22
  double fewest_rows_per_bin = 20.0;
  /// [share of a bin] That the friction curve leaves free; below, it says nothing. Source: reasoning.
  /// 2026-11-22
  double least_free_share = 0.05;
  /// [share of the false alarms] May be `unexplained`, in equal parts by each class of structure. Source:
  /// reasoning; what is left for the causes is hardly less. 2026-11-22
  double share_of_false_alarms = 0.1;
  /// [bins] Of the position over the stroke. Source: reasoning; each a fiftieth of the stroke. 2026-11-22
  static constexpr int position_bins = 48;
  /// [bins] Of the speed, slow ones finer. Source: reasoning. 2026-11-22
  static constexpr int speed_bins = 16;
  /// [bins] Of the travel since a reversal, by its logarithm. Source: reasoning. 2026-11-22
  static constexpr int travel_bins = 14;
  /// [bins] Of the motor's angle. Source: reasoning; orders up to 24. 2026-11-22
  static constexpr int angle_bins = 48;
  /// [bins] Of the temperature. Source: reasoning. 2026-11-22
  static constexpr int temperature_bins = 12;
  /// [s] Of a bin of time, as a torque. Source: reasoning. 2026-11-22
  double torque_bin_s = 0.25;
  /// [s] Of a bin of time, as friction. Source: reasoning. 2026-11-22
  double friction_bin_s = 1.0;
  /// [m] Travel since a reversal that the bins begin with. Source: reasoning; below the length of a bristle.
  /// 2026-11-22
  double shortest_travel_m = 1e-6;
};

inline constexpr AdequacyTuning kAdequacy;

}  // namespace contour::diagnosis
