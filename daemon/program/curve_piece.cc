#include "daemon/program/curve_piece.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

/// How far the axes beside the plane are from the start along the helix's axis, and the square of their
/// distance from it. `direction` is zero in a flat arc.
struct Beside {
  double along_m = 0.0;
  double squared_m2 = 0.0;
};

Beside BesidePlane(const CurvePiece& arc, const PerAxis<double>& point) {
  Beside beside;
  double slope_squared = 0.0, projected = 0.0;
  for (std::size_t i = 0; i < point.size(); ++i) {
    if (i == arc.axis[0] || i == arc.axis[1]) continue;
    const double away = point[i] - arc.start_m[i];
    beside.squared_m2 += away * away;
    projected += away * arc.direction[i];
    slope_squared += arc.direction[i] * arc.direction[i];
  }
  if (slope_squared == 0.0) return beside;
  beside.along_m = projected / std::sqrt(slope_squared);
  beside.squared_m2 = std::max(0.0, beside.squared_m2 - beside.along_m * beside.along_m);
  return beside;
}

/// Square of the distance from a helix at the angle phi since its start, with its first two derivatives.
struct HelixDistance {
  double radius_m, point_radius_m, point_rad, rise_m_rad, along_m;
  [[nodiscard]] double Squared(double phi) const {
    const double up = along_m - rise_m_rad * phi;
    return radius_m * radius_m + point_radius_m * point_radius_m -
           2.0 * radius_m * point_radius_m * std::cos(phi - point_rad) + up * up;
  }
  [[nodiscard]] double NewtonStep(double phi) const {
    const double moment = radius_m * point_radius_m;
    const double slope = moment * std::sin(phi - point_rad) - rise_m_rad * (along_m - rise_m_rad * phi);
    const double bend = moment * std::cos(phi - point_rad) + rise_m_rad * rise_m_rad;
    return -slope / std::max(bend, 0.1 * (moment + rise_m_rad * rise_m_rad));
  }
  /// Least square near phi, within 0 to turn.
  [[nodiscard]] double LeastNear(double phi, double turn_rad) const {
    constexpr int kNewtonSteps = 20;
    constexpr double kThere_rad = 1e-12;
    double least = Squared(phi);
    for (int k = 0; k < kNewtonSteps; ++k) {
      const double next = std::clamp(phi + NewtonStep(phi), 0.0, turn_rad);
      least = std::min(least, Squared(next));
      if (std::abs(next - phi) < kThere_rad) break;
      phi = next;
    }
    return least;
  }
};

/// The nearest point lies within a turn of where the helix is as high as the point, or of the end next to
/// that: tried from every start that is lower than its neighbours.
double DistanceToHelix_m(const CurvePiece& arc, const PerAxis<double>& point) {
  constexpr int kStarts = 24;
  const double dx = point[arc.axis[0]] - arc.centre_m[0], dy = point[arc.axis[1]] - arc.centre_m[1];
  const double turn = std::abs(arc.sweep_rad), sense = arc.sweep_rad < 0.0 ? -1.0 : 1.0;
  const double rise = std::sqrt(std::max(0.0, 1.0 - arc.round_share * arc.round_share)) * arc.length_m / turn;
  const Beside beside = BesidePlane(arc, point);
  const HelixDistance distance{arc.radius_m, std::hypot(dx, dy), sense * (std::atan2(dy, dx) - arc.start_rad),
                               rise, beside.along_m};
  const double level = std::clamp(beside.along_m / rise, 0.0, turn);
  const auto start = [&](int k) {
    return std::clamp(level + 3.0 * kTurn_rad * (static_cast<double>(k) / kStarts - 0.5), 0.0, turn);
  };
  double best = std::min(distance.Squared(0.0), distance.Squared(turn));
  double before = std::numeric_limits<double>::infinity(), here = distance.Squared(start(0));
  for (int k = 0; k <= kStarts; ++k) {
    const double after =
        k == kStarts ? std::numeric_limits<double>::infinity() : distance.Squared(start(k + 1));
    if (here <= before && here <= after) best = std::min(best, distance.LeastNear(start(k), turn));
    before = here;
    here = after;
  }
  return std::sqrt(std::max(0.0, best) + beside.squared_m2);
}

double DistanceToArc_m(const CurvePiece& arc, const PerAxis<double>& point) {
  if (arc.round_share < 1.0) return DistanceToHelix_m(arc, point);
  const double dx = point[arc.axis[0]] - arc.centre_m[0];
  const double dy = point[arc.axis[1]] - arc.centre_m[1];
  if (!Covers(arc, std::atan2(dy, dx))) {
    return std::sqrt(std::min(SquaredDistance(point, arc.start_m),
                              SquaredDistance(point, PointAt(arc, arc.length_m).position_m)));
  }
  return std::sqrt(std::pow(std::hypot(dx, dy) - arc.radius_m, 2) + BesidePlane(arc, point).squared_m2);
}

double DistanceToSine_m(const CurvePiece& sine, const PerAxis<double>& point) {
  PerAxis<double> nearest = sine.start_m;
  const std::size_t a = sine.axis[0];
  nearest[a] = std::clamp(point[a], sine.start_m[a] - sine.radius_m, sine.start_m[a] + sine.radius_m);
  return std::sqrt(SquaredDistance(point, nearest));
}

CurvePoint PointOnArc(const CurvePiece& arc, double s_m, CurvePoint p) {
  const double sense = arc.sweep_rad < 0.0 ? -1.0 : 1.0;
  const double share = arc.round_share;
  const double angle = arc.start_rad + sense * share * s_m / arc.radius_m;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  p.position_m[arc.axis[0]] = arc.centre_m[0] + arc.radius_m * c;
  p.position_m[arc.axis[1]] = arc.centre_m[1] + arc.radius_m * s;
  p.tangent[arc.axis[0]] = -sense * share * s;
  p.tangent[arc.axis[1]] = sense * share * c;
  p.curvature_1_m[arc.axis[0]] = -share * share * c / arc.radius_m;
  p.curvature_1_m[arc.axis[1]] = -share * share * s / arc.radius_m;
  for (std::size_t i = 0; i < p.position_m.size() && share < 1.0; ++i) {
    if (i == arc.axis[0] || i == arc.axis[1]) continue;
    p.position_m[i] += s_m * arc.direction[i];
    p.tangent[i] = arc.direction[i];
  }
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

CurvePiece HelixPiece(const PerAxis<double>& from_m, const PerAxis<double>& to_m,
                      std::array<std::size_t, 2> plane, std::array<double, 2> centre_m, double sweep_rad) {
  CurvePiece piece = ArcPiece(from_m, plane, centre_m, sweep_rad);
  const double round_m = piece.length_m;
  double squared = 0.0;
  for (std::size_t i = 0; i < from_m.size(); ++i)
    if (i != plane[0] && i != plane[1]) squared += (to_m[i] - from_m[i]) * (to_m[i] - from_m[i]);
  if (squared == 0.0) return piece;
  piece.length_m = std::sqrt(round_m * round_m + squared);
  piece.round_share = round_m / piece.length_m;
  for (std::size_t i = 0; i < from_m.size(); ++i)
    if (i != plane[0] && i != plane[1]) piece.direction[i] = (to_m[i] - from_m[i]) / piece.length_m;
  return piece;
}

CurvePiece PartOfArc(const CurvePiece& arc, double from_m, double to_m) {
  CurvePiece part = arc;
  const double rad_m = arc.sweep_rad / arc.length_m;
  part.start_m = PointAt(arc, from_m).position_m;
  part.length_m = to_m - from_m;
  part.start_rad = arc.start_rad + from_m * rad_m;
  part.sweep_rad = part.length_m * rad_m;
  return part;
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

double DistanceToBox_m(const Extent& box, const PerAxis<double>& point_m) {
  double squared = 0.0;
  for (std::size_t i = 0; i < point_m.size(); ++i) {
    const double outside = std::max({box.min_m[i] - point_m[i], 0.0, point_m[i] - box.max_m[i]});
    squared += outside * outside;
  }
  return std::sqrt(squared);
}

void Enlarge(Extent& box, const Extent& by) {
  for (std::size_t i = 0; i < box.min_m.size(); ++i) {
    box.min_m[i] = std::min(box.min_m[i], by.min_m[i]);
    box.max_m[i] = std::max(box.max_m[i], by.max_m[i]);
  }
}

}  // namespace contour
