#pragma once

#include "config/machine_config.h"

// By how much the table is off the 10 mm circle under `full`, in either mode, from the axis's own numbers.
// Rules of thumb: of the errors of 18 machines of 5 to 500 kg (docs/laboratory/family.md, "Which mode") they
// are 0.3 to 2.1 times as much.
namespace contour {

/// Of the friction that turns round at a reversal, what is not foreseen gives the table this far way. Where a
/// drive closes the loop it is the screw that gives way, and the table goes on swinging on it, damped by the
/// screw alone, the more the less of a period of that swing the reversal takes; and the drive's velocity loop
/// answers counts of its encoder. What is made of its reports comes on top, unless it is averaged, as where
/// counts hide friction that is learnt along the reference. Of a drive that holds the motor well.
double CircleErrorByDrive_m(const AxisConfig& axis, bool averaged);

/// The same of a drive that nothing is fed forward to, `machine.controller: csp`: all of friction winds the
/// screw up, and its counts are only those of its own loop.
double CircleErrorByDriveAlone_m(const AxisConfig& axis);

/// The same where torques come from here; `compliance_m_N`: of the table, at most, under a force that steps
/// through a lag of 4 ms.
double CircleErrorByTorque_m(const AxisConfig& axis, double compliance_m_N);

/// The same of a loop as most axes have it, where none has been designed.
double UsualCircleErrorByTorque_m(const AxisConfig& axis);

/// Errors that differ by less are the same.
inline constexpr double kModesDiffer = 1.25;

}  // namespace contour
