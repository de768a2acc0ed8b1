#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// A recorded axis as identification and diagnosis see it, whatever file it came from.
//
// Generalised coordinates. A rotary axis is seen at the motor: q in rad, u in Nm. A linear axis (columns
// force_N, position_m) is seen at the carriage: q in m, u in N. Code of this folder writes `q` and `u` where
// both are meant.
namespace contour::diagnosis {

/// Timing: row k holds the position latched at t_k and the command computed from it, which begins to act at
/// t_k + delay, through the drive's first-order lag, and is held until the next.
struct AxisLog {
  std::string source;  ///< file, for messages
  std::string axis;    ///< its name; empty when not known
  bool linear = false;
  double period_s = 1e-3;
  bool from_velocity = false;  ///< `position` is the integral of a velocity: nobody recorded one
  bool in_ampere = false;      ///< `command` is a current: what it is in Nm or N, the model has to say
  std::string note;            ///< what was done to the file's rows before; empty: nothing

  /// All vectors have one element per grid point from the first to the last row: a missing row has
  /// present[k] == 0 and the last known command (a drive goes on with it), position NaN.
  std::vector<std::uint8_t> present;
  std::vector<double> command;  ///< u, as commanded and quantised
  /// Where the drive closes its own loop, and `command` is made of these: u that was sent besides, timed as a
  /// command, and u that the drive said it gave at t_k. Empty elsewhere.
  std::vector<double> offset, reported;
  std::vector<double> position;            ///< q, as measured and quantised; NaN where missing
  std::vector<double> table_position_m;    ///< linear scale; empty without one
  std::vector<double> temperature_degC;    ///< empty without one
  std::vector<double> axis2_position_m;    ///< empty without one
  std::vector<double> reference_position;  ///< q, what was asked for; empty when not recorded

  std::size_t rows = 0;            ///< rows of the file
  std::size_t missing = 0;         ///< grid points without a row
  std::size_t wrong_readings = 0;  ///< rows whose position was taken out as a single wrong reading

  std::size_t size() const { return command.size(); }
};

/// Rows, the first among them, from which the axis is looked at anew: what comes after a gap of more than
/// 10 ms and three rows has nothing to do with what was before it.
std::vector<std::size_t> Beginnings(const AxisLog& log);
/// Whether so many grid points without a row are such a gap.
bool IsGap(std::size_t missing, double period_s);

}  // namespace contour::diagnosis
