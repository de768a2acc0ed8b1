#pragma once

#include <complex>

#include "core/two_inertia_axis.h"

namespace contour {

/// The loop that a drive closes round a motor by itself: position P, velocity PI. Force at the table
///   F = velocity_Ns_m (1 + integral_1_s / s) (position_1_s (target - p) - v) e^(-s late_s)
/// with p and v of the motor, through the axis's lag of the current loop.
struct DriveLoop {
  double velocity_Ns_m = 0.0;
  double position_1_s = 0.0;
  double integral_1_s = 0.0;
  double late_s = 0.0;         ///< of the loop itself: its period, its filters
  double offset_late_s = 0.0;  ///< from the sample to a torque offset computed from it
};

/// What the loop makes of one axis, continuous in time.
class DriveLoopOn {
 public:
  DriveLoopOn(const TwoInertiaAxis& axis, const DriveLoop& loop) : axis_(axis), loop_(loop) {}

  /// Loop gain, opened at the force.
  [[nodiscard]] std::complex<double> Gain(double frequency_Hz) const;
  /// Travel of the motor per torque offset that is held over one period each, m/N.
  [[nodiscard]] std::complex<double> OffsetToMotor(double frequency_Hz, double period_s) const;
  /// Travel of the table per force on the table, m/N.
  [[nodiscard]] std::complex<double> ForceToTable(double frequency_Hz) const;

 private:
  [[nodiscard]] std::complex<double> Motor(std::complex<double> s) const;
  [[nodiscard]] std::complex<double> Feedback(std::complex<double> s) const;
  TwoInertiaAxis axis_;
  DriveLoop loop_;
};

/// How far the drive's loop is from instability, and what a force does to the table.
struct DriveLoopFigures {
  double peak = 0.0;  ///< of sensitivity, 1 / min |1 + L|
  double peak_Hz = 0.0;
  double phase_margin_deg = 0.0;
  double bandwidth_Hz = 0.0;        ///< lowest frequency at which |L| falls to 1
  double stiffness_1Hz_N_um = 0.0;  ///< force on the table per travel of it
  double stiffness_10Hz_N_um = 0.0;
  double least_stiffness_N_um = 0.0;
  double step_peak_m = 0.0;  ///< of the table under a force that steps through a lag of 4 ms
  /// By this factor all its gains may rise together until the peak of sensitivity is 2; below 1 where it is
  /// above already.
  double gain_room = 0.0;
};
DriveLoopFigures FiguresOf(const TwoInertiaAxis& axis, const DriveLoop& loop, double step_N);

}  // namespace contour
