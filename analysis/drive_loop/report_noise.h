#pragma once

#include <span>

#include "analysis/drive_loop/drive_record.h"

namespace contour {

/// What the torque that a drive reports of a moving axis scatters by, rms of one report: its velocity loop
/// answers every count that flickers, several times between two reports, and each of those pushes. From what
/// one report differs by from the one before, less what was sent; where an experiment pushes, nothing is
/// taken. 0: there is too little.
double ReportNoise_N(std::span<const DriveSample> samples);

}  // namespace contour
