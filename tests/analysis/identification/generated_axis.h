#pragma once

#include <functional>
#include <vector>

#include "analysis/identification/simulation.h"
#include "tools/plant_emulator/axis_parameters.h"

namespace contour::test {

/// An emulated axis (whose code identification does not know) led along a path by a plain controller, without
/// a daemon: what a log of it would hold.
struct GeneratedAxis {
  plant::AxisParameters truth;
  bool scale = false;
  double noise_lsb = 0.3;
  double torque_noise_N = 0.0;  ///< of the mean over a period, not in what was commanded

  /// Seconds into the run to the wanted position, m, and an extra force, N.
  using Path = std::function<double(double time_s)>;
  identify::Measured Drive(double seconds, const Path& position_m, const Path& extra_N) const;
  /// Led by the drive's own loop, eight times a period; the extra force is its offset.
  identify::Measured LedByDrive(double seconds, const Path& position_m, const Path& offset_N) const;
};

/// The nominal axis without variation over place and turn, and the model that states it exactly.
plant::AxisParameters PlainAxis();
identify::TableAxis Exactly(const plant::AxisParameters& truth);

/// A path of strokes at each speed, forth and back, with smooth ends.
GeneratedAxis::Path Strokes(double stroke_m, std::vector<double> speeds_m_s);
double StrokesDuration_s(double stroke_m, const std::vector<double>& speeds_m_s);

/// Strokes at speeds from 0.5 to 50 mm/s.
const identify::Measured& SlidingRecord();
/// Half a minute of everything: strokes, loops, shaking at rest, a chirp while sliding.
const identify::Measured& Everything();

}  // namespace contour::test
