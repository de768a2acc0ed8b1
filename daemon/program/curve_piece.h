#pragma once

#include <array>

#include "core/axis.h"

namespace contour {

/// A position on a curve with its derivatives by the curve's parameter s.
struct CurvePoint {
  PerAxis<double> position_m;
  PerAxis<double> tangent;        ///< dp/ds
  PerAxis<double> curvature_1_m;  ///< d2p/ds2
};

/// One smooth piece of a path, all axes, by parameter s from 0 to length_m. s is the arc length, but for the
/// sine, where it is the arc length of the circle whose projection the sine is.
struct CurvePiece {
  enum class Kind { kPoint, kLine, kArc, kSine };
  Kind kind = Kind::kPoint;
  PerAxis<double> start_m;
  double length_m = 0.0;
  PerAxis<double> direction;          ///< line: unit vector; helix: of the axes beside its plane, per s
  std::array<std::size_t, 2> axis{};  ///< arc: its plane; sine: [0] is its axis
  std::array<double, 2> centre_m{};   ///< arc
  double radius_m = 0.0;              ///< arc; sine: amplitude
  double start_rad = 0.0;             ///< arc: angle of the start point about the centre
  double sweep_rad = 0.0;             ///< arc: signed, positive counter-clockwise
  double round_share = 1.0;           ///< arc: way in its plane per s; below 1 in a helix
};

CurvePiece PointPiece(const PerAxis<double>& at_m);
CurvePiece LinePiece(const PerAxis<double>& from_m, const PerAxis<double>& to_m);
/// Starts at `from`; its radius is the distance of `from` to the centre.
CurvePiece ArcPiece(const PerAxis<double>& from_m, std::array<std::size_t, 2> plane,
                    std::array<double, 2> centre_m, double sweep_rad);
/// An arc whose other axes move evenly from start to end: a helix. In the plane the arc decides where it
/// ends.
CurvePiece HelixPiece(const PerAxis<double>& from_m, const PerAxis<double>& to_m,
                      std::array<std::size_t, 2> plane, std::array<double, 2> centre_m, double sweep_rad);
/// What lies between two s of an arc or a helix.
CurvePiece PartOfArc(const CurvePiece& arc, double from_m, double to_m);
/// p = start + amplitude sin(s / amplitude) on one axis.
CurvePiece SinePiece(const PerAxis<double>& middle_m, std::size_t axis, double amplitude_m, int cycles);

CurvePoint PointAt(const CurvePiece& piece, double s_m);

/// Shortest distance from a point to the piece.
double Distance_m(const CurvePiece& piece, const PerAxis<double>& point_m);

/// Smallest and largest coordinate of the piece on each axis.
struct Extent {
  PerAxis<double> min_m;
  PerAxis<double> max_m;
};
Extent ExtentOf(const CurvePiece& piece);
/// From a point to the nearest of the box; 0 inside.
double DistanceToBox_m(const Extent& box, const PerAxis<double>& point_m);
/// The smallest box around both.
void Enlarge(Extent& box, const Extent& by);

}  // namespace contour
