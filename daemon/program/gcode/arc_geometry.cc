#include "daemon/program/gcode/arc_geometry.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

namespace contour {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr double kInch_m = 0.0254;
// LinuxCNC's: ends that were rounded to a hundredth of a millimetre or a thousandth of an inch, and, beyond
// that, to a thousandth of the radius, but never by a hundred times the former.
constexpr double kEndsMetric_m = 2.0 * 1e-5 * std::numbers::sqrt2;
constexpr double kEndsInch_m = 2.0 * 1e-3 * kInch_m * std::numbers::sqrt2;
constexpr double kEndsRelative = 1e-3;
constexpr double kEndsLargest = 100.0;
constexpr double kRadius_m = 5e-5 * kInch_m;
// A chord this near to the diameter is the diameter: beyond it the height of the arc is rounding.
constexpr double kNearlyHalfTurn = 1e-12;
// Ends this near to each other are the same, when a program has come there by increments.
constexpr double kSamePoint_m = 1e-9;
// An end this little after the start, seen from the centre, is the start, once round.
constexpr double kWholeTurn_rad = 1e-6;

std::string Millimetres(double value_m) {
  std::array<char, 400> buffer{};  // of any double
  const double rounded = std::round(value_m * 1e9) / 1e6;
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), rounded, std::chars_format::fixed);
  return std::string(buffer.data(), end.ptr) + " mm";
}

double Distance(const PlanePoint& a, const PlanePoint& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

}  // namespace

ArcTolerance ToleranceOfArcs(bool inches) { return {kRadius_m, inches ? kEndsInch_m : kEndsMetric_m}; }

std::optional<std::string> WrongCentre(const ArcEnds& ends, const PlanePoint& centre_m,
                                       const ArcTolerance& tolerance) {
  const double at_start = Distance(ends.from_m, centre_m);
  const double at_end = Distance(ends.to_m, centre_m);
  const double radius = std::min(at_start, at_end);
  if (radius < kSamePoint_m) return "the arc's radius is zero";
  if (radius < tolerance.radius_m)
    return "the arc's radius of " + Millimetres(radius) + " is too small, expected at least " +
           Millimetres(tolerance.radius_m) + " as LinuxCNC does";
  const double differ = std::abs(at_start - at_end);
  const bool much = differ > kEndsRelative * std::max(at_start, at_end) && differ > tolerance.ends_m;
  if (!much && differ <= kEndsLargest * tolerance.ends_m) return std::nullopt;
  return "the arc's end is " + Millimetres(at_end) + " from its centre, its start " + Millimetres(at_start);
}

PlanePoint CentreByRadius(const ArcEnds& ends, double radius_m, const ArcTolerance& tolerance,
                          std::optional<std::string>& wrong) {
  const double radius = std::abs(radius_m);
  const double chord = Distance(ends.from_m, ends.to_m);
  const PlanePoint middle = {0.5 * (ends.from_m[0] + ends.to_m[0]), 0.5 * (ends.from_m[1] + ends.to_m[1])};
  if (chord < kSamePoint_m) {
    wrong = "an arc with R needs an end other than its start; use centre offsets for a full circle";
    return middle;
  }
  if (!(radius > 0.0) || 0.5 * chord - radius > tolerance.radius_m) {
    wrong = "R " + Millimetres(radius) + " is too small for an arc over " + Millimetres(chord);
    return middle;
  }
  const double sine = 0.5 * chord / radius;
  const double height = sine > 1.0 - kNearlyHalfTurn ? 0.0 : radius * std::cos(std::asin(sine));
  const double side = ends.ccw == (radius_m > 0.0) ? 1.0 : -1.0;
  return {middle[0] - side * height * (ends.to_m[1] - ends.from_m[1]) / chord,
          middle[1] + side * height * (ends.to_m[0] - ends.from_m[0]) / chord};
}

double SweepOf_rad(const ArcEnds& ends, const PlanePoint& centre_m, int turns) {
  const double from = std::atan2(ends.from_m[1] - centre_m[1], ends.from_m[0] - centre_m[0]);
  const double to = std::atan2(ends.to_m[1] - centre_m[1], ends.to_m[0] - centre_m[0]);
  const double sense = ends.ccw ? 1.0 : -1.0;
  double sweep = sense * (to - from);
  sweep -= kTurn_rad * std::floor(sweep / kTurn_rad);
  if (sweep < kWholeTurn_rad) sweep += kTurn_rad;
  return sense * (sweep + kTurn_rad * (std::abs(turns) - 1));
}

}  // namespace contour
