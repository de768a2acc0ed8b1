#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "analysis/drive_loop/drive_record.h"

namespace contour {

/// How far a force on the motor moves a sliding axis that its drive holds: travel per force over frequency,
/// m/N, from the sample at which the force was computed.
struct DriveResponse {
  struct Line {
    double frequency_Hz = 0.0;
    std::complex<double> compliance_m_N;
    double scatter_rel = 0.0;  ///< one standard deviation of the mean over the stretches
  };
  std::vector<Line> lines;
  std::size_t stretches = 0;  ///< periods of the excitation that were averaged
};

/// From the stretches in which a periodic excitation acts while the reference slides at one speed:
/// `period_cycles` long each, one after the other. What is periodic in the excitation shows at its lines
/// alone, so that nothing leaks; whatever else the axis did in a stretch is noise, and the scatter tells how
/// much. Empty when there are fewer than four stretches.
DriveResponse MeasureDrive(std::span<const DriveSample> samples, double period_s, std::size_t period_cycles);

}  // namespace contour
