#pragma once

#include <array>
#include <optional>
#include <string>

namespace contour {

using PlanePoint = std::array<double, 2>;

/// An arc in its plane, in metres, before its centre is known.
struct ArcEnds {
  PlanePoint from_m{};
  PlanePoint to_m{};
  bool ccw = true;
};

/// Half an arc's rules depend on the units of the program.
struct ArcTolerance {
  double radius_m = 0.0;  ///< by how much R may be too small; a smaller radius counts as none
  double ends_m = 0.0;    ///< by how much the radii at start and end may differ without more ado
};
ArcTolerance ToleranceOfArcs(bool inches);

/// What is wrong with the centre, or nothing.
std::optional<std::string> WrongCentre(const ArcEnds& ends, const PlanePoint& centre_m,
                                       const ArcTolerance& tolerance);

/// Centre of the arc of radius R: at most half a turn, or the longer one when R is negative. What is wrong
/// with R comes in `wrong`.
PlanePoint CentreByRadius(const ArcEnds& ends, double radius_m, const ArcTolerance& tolerance,
                          std::optional<std::string>& wrong);

/// Angle from start to end about the centre, signed, of an arc of |turns| begun turns.
double SweepOf_rad(const ArcEnds& ends, const PlanePoint& centre_m, int turns);

}  // namespace contour
