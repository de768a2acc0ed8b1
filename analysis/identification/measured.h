#pragma once

#include <cstdint>
#include <vector>

namespace contour::identify {

/// What was measured, in table units. Timing as diagnosis::AxisLog states it.
struct Measured {
  double period_s = 1e-3;
  double position_step_m = 0.0;  ///< one count of the encoder
  std::vector<double> force_N;   ///< command / R
  /// Where the drive closes its own loop: the offset that it was sent, in the place of the command, and what
  /// it said that it gave at the instant of the position. Empty elsewhere.
  std::vector<double> offset_N, reported_N;
  double report_step_N = 0.0;         ///< to which it said it
  std::vector<double> position_m;     ///< R theta
  std::vector<double> table_m;        ///< linear scale; empty without one
  std::vector<std::uint8_t> present;  ///< 0: no sample at this grid point
  /// So many rows at the beginning are simulated and not compared, so that what is compared begins with what
  /// swings already.
  std::size_t run_up = 0;
  [[nodiscard]] std::size_t size() const { return force_N.size(); }
  [[nodiscard]] std::size_t compared() const { return size() - run_up; }
  [[nodiscard]] bool led_by_drive() const { return !reported_N.empty(); }
};

}  // namespace contour::identify
