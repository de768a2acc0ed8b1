#include "daemon/program/curve_piece.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contour {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;

PerAxis<double> Filled(std::size_t size, double value) {
  PerAxis<double> v(size);
  std::fill(v.begin(), v.end(), value);
  return v;
}

double SquaredDistance(const PerAxis<double>& a, const PerAxis<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

double DistanceToLine_m(const CurvePiece& line, const PerAxis<double>& point) {
  double along = 0.0;
  for (std::size_t i = 0; i < point.size(); ++i) along += (point[i] - line.start_m[i]) * line.direction[i];
  return std::sqrt(SquaredDistance(point, PointAt(line, std::clamp(along, 0.0, line.length_m)).position_m));
}

// Does the arc pass the direction `angle` as seen from its centre?
bool Covers(const CurvePiece& arc, double angle_rad) {
  const double sense = arc.sweep_rad < 0.0 ? -1.0 : 1.0;
  const double since_start = sense * (angle_rad - arc.start_rad);
  const double wrapped = since_start - kTurn_rad * std::floor(since_start / kTurn_rad);
  return wrapped <= std::abs(arc.sweep_rad);
}

double DistanceToArc_m(const CurvePiece& arc, const PerAxis<double>& point) {
  const double dx = point[arc.axis[0]] - arc.centre_m[0];
  const double dy = point[arc.axis[1]] - arc.centre_m[1];
  if (!Covers(arc, std::atan2(dy, dx))) {
    return std::sqrt(std::min(SquaredDistance(point, arc.start_m),
                              SquaredDistance(point, PointAt(arc, arc.length_m).position_m)));
  }
  double squared = std::pow(std::hypot(dx, dy) - arc.radius_m, 2);
  for (std::size_t i = 0; i < point.size(); ++i) {
    if (i != arc.axis[0] && i != arc.axis[1]) squared += std::pow(point[i] - arc.start_m[i], 2);
  }
  return std::sqrt(squared);
}

double DistanceToSine_m(const CurvePiece& sine, const PerAxis<double>& point) {
  PerAxis<double> nearest = sine.start_m;
  const std::size_t a = sine.axis[0];
  nearest[a] = std::clamp(point[a], sine.start_m[a] - sine.radius_m, sine.start_m[a] + sine.radius_m);
  return std::sqrt(SquaredDistance(point, nearest));
}

CurvePoint PointOnArc(const CurvePiece& arc, double s_m, CurvePoint p) {
  const double sense = arc.sweep_rad < 0.0 ? -1.0 : 1.0;
  const double angle = arc.start_rad + sense * s_m / arc.radius_m;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  p.position_m[arc.axis[0]] = arc.centre_m[0] + arc.radius_m * c;
  p.position_m[arc.axis[1]] = arc.centre_m[1] + arc.radius_m * s;
  p.tangent[arc.axis[0]] = -sense * s;
  p.tangent[arc.axis[1]] = sense * c;
  p.curvature_1_m[arc.axis[0]] = -c / arc.radius_m;
  p.curvature_1_m[arc.axis[1]] = -s / arc.radius_m;
  return p;
}

}  // namespace

CurvePiece PointPiece(const PerAxis<double>& at_m) {
  CurvePiece piece;
  piece.start_m = at_m;
  piece.direction = Filled(at_m.size(), 0.0);
  return piece;
}

CurvePiece LinePiece(const PerAxis<double>& from_m, const PerAxis<double>& to_m) {
  CurvePiece piece = PointPiece(from_m);
  piece.kind = CurvePiece::Kind::kLine;
  piece.length_m = std::sqrt(SquaredDistance(from_m, to_m));
  for (std::size_t i = 0; i < from_m.size() && piece.length_m > 0.0; ++i) {
    piece.direction[i] = (to_m[i] - from_m[i]) / piece.length_m;
  }
  return piece;
}

CurvePiece ArcPiece(const PerAxis<double>& from_m, std::array<std::size_t, 2> plane,
                    std::array<double, 2> centre_m, double sweep_rad) {
  CurvePiece piece = PointPiece(from_m);
  piece.kind = CurvePiece::Kind::kArc;
  piece.axis = plane;
  piece.centre_m = centre_m;
  const double dx = from_m[plane[0]] - centre_m[0];
  const double dy = from_m[plane[1]] - centre_m[1];
  piece.radius_m = std::hypot(dx, dy);
  piece.start_rad = std::atan2(dy, dx);
  piece.sweep_rad = sweep_rad;
  piece.length_m = piece.radius_m * std::abs(sweep_rad);
  return piece;
}

CurvePiece SinePiece(const PerAxis<double>& middle_m, std::size_t axis, double amplitude_m, int cycles) {
  CurvePiece piece = PointPiece(middle_m);
  piece.kind = CurvePiece::Kind::kSine;
  piece.axis = {axis, axis};
  piece.radius_m = amplitude_m;
  piece.length_m = kTurn_rad * amplitude_m * cycles;
  return piece;
}

CurvePoint PointAt(const CurvePiece& piece, double s_m) {
  const std::size_t n = piece.start_m.size();
  CurvePoint p{piece.start_m, Filled(n, 0.0), Filled(n, 0.0)};
  switch (piece.kind) {
    case CurvePiece::Kind::kPoint:
      break;
    case CurvePiece::Kind::kLine:
      for (std::size_t i = 0; i < n; ++i) p.position_m[i] += s_m * piece.direction[i];
      p.tangent = piece.direction;
      break;
    case CurvePiece::Kind::kArc:
      return PointOnArc(piece, s_m, p);
    case CurvePiece::Kind::kSine: {
      const std::size_t a = piece.axis[0];
      const double phase = s_m / piece.radius_m;
      p.position_m[a] += piece.radius_m * std::sin(phase);
      p.tangent[a] = std::cos(phase);
      p.curvature_1_m[a] = -std::sin(phase) / piece.radius_m;
      break;
    }
  }
  return p;
}

double Distance_m(const CurvePiece& piece, const PerAxis<double>& point_m) {
  switch (piece.kind) {
    case CurvePiece::Kind::kPoint:
      break;
    case CurvePiece::Kind::kLine:
      return DistanceToLine_m(piece, point_m);
    case CurvePiece::Kind::kArc:
      return DistanceToArc_m(piece, point_m);
    case CurvePiece::Kind::kSine:
      return DistanceToSine_m(piece, point_m);
  }
  return std::sqrt(SquaredDistance(piece.start_m, point_m));
}

Extent ExtentOf(const CurvePiece& piece) {
  const PerAxis<double> end = PointAt(piece, piece.length_m).position_m;
  Extent e{piece.start_m, piece.start_m};
  for (std::size_t i = 0; i < end.size(); ++i) {
    e.min_m[i] = std::min(piece.start_m[i], end[i]);
    e.max_m[i] = std::max(piece.start_m[i], end[i]);
  }
  if (piece.kind == CurvePiece::Kind::kSine) {
    e.min_m[piece.axis[0]] = piece.start_m[piece.axis[0]] - piece.radius_m;
    e.max_m[piece.axis[0]] = piece.start_m[piece.axis[0]] + piece.radius_m;
  }
  if (piece.kind == CurvePiece::Kind::kArc) {
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t a = piece.axis[k];
      const double reversal_rad = k == 0 ? 0.0 : 0.5 * std::numbers::pi;
      if (Covers(piece, reversal_rad)) e.max_m[a] = piece.centre_m[k] + piece.radius_m;
      if (Covers(piece, reversal_rad + std::numbers::pi)) e.min_m[a] = piece.centre_m[k] - piece.radius_m;
    }
  }
  return e;
}

}  // namespace contour
