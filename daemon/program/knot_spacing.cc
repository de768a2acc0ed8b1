#include "daemon/program/knot_spacing.h"

#include <algorithm>
#include <cmath>

namespace contour {
namespace {

// A single corner, smoothed by a cubic spline whose knots are h apart, is missed by h / 6 times the change of
// the unit tangent.
constexpr double kCornerWidth = 6.0;
// The corner itself may be missed by more than the path, in a sharp corner by this much.
constexpr double kCornerMiss = 2.0;
// Of the two triangles: share of the wide one, and width of the narrow one.
// (Measured on squares, diamonds and zigzags: docs/laboratory/motion_planning.md.)
constexpr double kWideShare = 0.5;
constexpr double kNarrow = 0.6;
// First guess where the curvature jumps; a smooth path's error there goes with jump and width squared.
constexpr double kBendWidth = 20.0;
// Knots on an arc: no farther apart than this share of the radius, and its error, h^4 / (100 R^3), is this
// share of the tolerance. The third derivative is constant between knots, and half of the first share off.
constexpr double kArcShare = 0.1;
constexpr double kArcTolerance = 0.05;
// A change of direction that comes from rounding. Larger ones count, as many of them may follow each other.
constexpr double kRounding_rad = 1e-8;
// Knots that are nearer to each other are the same.
constexpr double kSameKnot_m = 1e-12;
// How fast spacing may change along the path.
constexpr double kSlope = 0.5;

double Difference(const PerAxis<double>& a, const PerAxis<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

/// A stretch of way over which the spacing changes evenly.
struct Ramp {
  double from_m, to_m, spacing_from_m, spacing_to_m;

  /// How many spacings fit.
  [[nodiscard]] double Count() const {
    const double change = spacing_to_m - spacing_from_m;
    const double mean = 0.5 * (spacing_from_m + spacing_to_m);
    if (std::abs(change) < 1e-6 * mean) return (to_m - from_m) / mean;
    return std::log(spacing_to_m / spacing_from_m) * (to_m - from_m) / change;
  }
  /// Where `count` of them end.
  [[nodiscard]] double After(double count) const {
    const double change = (spacing_to_m - spacing_from_m) / (to_m - from_m);
    if (std::abs(change) < 1e-6) return from_m + count * 0.5 * (spacing_from_m + spacing_to_m);
    return from_m + spacing_from_m * std::expm1(change * count) / change;
  }
};

}  // namespace

KnotSpacing::KnotSpacing(const ProgrammedPath& path, const std::vector<double>& fixed)
    : fixed_(fixed), to_m_(path.to_m()), length_m_(path.to_m() - path.from_m()) {
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path.move(i).curve.radius_m > 0.0) AddArc(path, i);
    if (i + 1 < path.size()) AddJunction(path, i);
  }
  GoOnFromFixed();
  LimitSlope();
}

// Spacing goes on from what it is already, unless a lone corner has ended there.
void KnotSpacing::GoOnFromFixed() {
  const double at_m = fixed_.back(), last_m = at_m - fixed_[fixed_.size() - 2];
  if (last_m == 0.0) return;
  for (const LoneCorner& c : corners_)
    if (std::abs(c.at_m + c.outer_m - at_m) <= kSameKnot_m) return;
  controls_.insert(controls_.begin(), {at_m, last_m});
}

void KnotSpacing::AddJunction(const ProgrammedPath& path, std::size_t before) {
  const CurvePiece& a = path.move(before).curve;
  const CurvePiece& b = path.move(before + 1).curve;
  const double tolerance = path.move(before).tolerance_m;
  const double at = path.begin_m(before + 1);
  const CurvePoint end = PointAt(a, a.length_m), begin = PointAt(b, 0.0);
  const double turn = Difference(end.tangent, begin.tangent);
  turns_.push_back(turn);
  const double bend = Difference(end.curvature_1_m, begin.curvature_1_m);
  if (turn < kRounding_rad && bend * std::min(a.length_m, b.length_m) < kRounding_rad) return;
  PerAxis<double> change = begin.tangent;
  for (std::size_t i = 0; i < change.size(); ++i) change[i] -= end.tangent[i];
  if (AddLone(path, before, change)) return;
  double spacing = turn > 0.0 ? kCornerWidth * tolerance / turn : length_m_;
  if (bend > 0.0) spacing = std::min(spacing, std::sqrt(kBendWidth * tolerance / bend));
  AddControl(at, std::min(spacing, length_m_));
}

bool KnotSpacing::AddLone(const ProgrammedPath& path, std::size_t before, const PerAxis<double>& change) {
  const CurvePiece& a = path.move(before).curve;
  const CurvePiece& b = path.move(before + 1).curve;
  if (a.kind != CurvePiece::Kind::kLine || b.kind != CurvePiece::Kind::kLine) return false;
  double turn = 0.0;
  for (const double x : change) turn = std::hypot(turn, x);
  if (turn == 0.0) return false;
  const double cosine = std::sqrt(std::max(0.0, 1.0 - 0.25 * turn * turn));
  const double miss_m = path.move(before).tolerance_m / std::max(cosine, 1.0 / kCornerMiss);
  LoneCorner corner;
  corner.at_m = path.begin_m(before + 1);
  corner.outer_m = kCornerWidth * miss_m / (turn * (kWideShare + (1.0 - kWideShare) * kNarrow));
  corner.inner_m = kNarrow * corner.outer_m;
  if (corner.outer_m > 0.5 * std::min(a.length_m, b.length_m)) return false;
  const double pull = kWideShare * corner.outer_m * (1.0 - kNarrow * kNarrow) / 3.0;
  for (const double x : change) corner.pull_m.push_back(0.5 * pull * x);
  corners_.push_back(corner);
  return true;
}

void KnotSpacing::AddArc(const ProgrammedPath& path, std::size_t move) {
  const ProgrammedMove& m = path.move(move);
  const double radius = m.curve.radius_m;
  const double accurate = std::pow(100.0 * kArcTolerance * m.tolerance_m * radius * radius * radius, 0.25);
  const double spacing = std::min(kArcShare * radius, accurate);
  const int steps = 1 + static_cast<int>(2.0 * m.curve.length_m / spacing);
  for (int k = 0; k <= steps; ++k) AddControl(path.begin_m(move) + m.curve.length_m * k / steps, spacing);
}

void KnotSpacing::LimitSlope() {
  for (std::size_t i = 1; i < controls_.size(); ++i) {
    const double way = controls_[i].at_m - controls_[i - 1].at_m;
    controls_[i].spacing_m = std::min(controls_[i].spacing_m, controls_[i - 1].spacing_m + kSlope * way);
  }
  for (std::size_t i = controls_.size(); i-- > 1;) {
    const double way = controls_[i].at_m - controls_[i - 1].at_m;
    controls_[i - 1].spacing_m = std::min(controls_[i - 1].spacing_m, controls_[i].spacing_m + kSlope * way);
  }
}

double KnotSpacing::LargestTurn(std::size_t before, std::size_t end) const {
  double largest = 0.0;
  for (std::size_t i = before; i < end; ++i) largest = std::max(largest, turns_[i]);
  return largest;
}

void KnotSpacing::Note(double way_m, double reach_m, double factor) {
  const auto before = [](const Control& c, double way) { return c.at_m < way; };
  auto c = std::lower_bound(controls_.begin(), controls_.end(), way_m - reach_m, before);
  // The nearest one to either side at least.
  if (c != controls_.begin() && (c == controls_.end() || c->at_m > way_m)) --c;
  for (bool beyond = false; c != controls_.end() && !beyond; ++c) {
    beyond = c->at_m > way_m + reach_m;
    if (beyond && c->at_m - way_m > reach_m + c->spacing_m) break;
    c->factor = std::min(c->factor, factor);
  }
}

void KnotSpacing::Shrink() {
  for (Control& c : controls_) {
    c.spacing_m *= c.factor;
    c.factor = 1.0;
  }
  LimitSlope();
}

void KnotSpacing::Fill(double from_m, double to_m, std::size_t& control, std::vector<double>& knots) const {
  while (control < controls_.size() && controls_[control].at_m < from_m) ++control;
  std::size_t end = control;
  while (end < controls_.size() && controls_[end].at_m <= to_m) ++end;
  if (end == control) return;
  std::vector<Ramp> ramps;
  double at = from_m;
  double spacing = controls_[control].spacing_m + kSlope * (controls_[control].at_m - from_m);
  const auto to = [&](double way, double next) {
    if (way > at) ramps.push_back({at, way, spacing, next});
    at = way;
    spacing = next;
  };
  for (std::size_t i = control; i < end; ++i) {
    const Control& c = controls_[i];
    const double peak = 0.5 * (at + c.at_m + (c.spacing_m - spacing) / kSlope);
    if (peak > at && peak < c.at_m) to(peak, spacing + kSlope * (peak - at));
    to(c.at_m, c.spacing_m);
  }
  to(to_m, spacing + kSlope * (to_m - at));
  double count = 0.0;
  for (const Ramp& r : ramps) count += r.Count();
  const double pieces = std::max(1.0, std::ceil(count));
  double passed = 0.0;
  double next = 1.0;
  for (const Ramp& r : ramps) {
    const double here = r.Count();
    for (; next < pieces - 0.5 && count * next / pieces <= passed + here; ++next)
      knots.push_back(r.After(count * next / pieces - passed));
    passed += here;
  }
  control = end;
}

std::vector<double> KnotSpacing::Knots() const {
  std::vector<double> knots = fixed_;
  std::size_t control = 0;
  const auto add = [&](double knot) {
    if (knot > knots.back() + kSameKnot_m) knots.push_back(knot);
  };
  for (const LoneCorner& c : corners_) {
    if (c.at_m <= fixed_.back()) continue;
    Fill(knots.back(), c.at_m - c.outer_m, control, knots);
    for (const double side_m : {-c.outer_m, -c.inner_m, 0.0, c.inner_m, c.outer_m}) add(c.at_m + side_m);
  }
  Fill(knots.back(), to_m_, control, knots);
  while (knots.size() > fixed_.size() && knots.back() > to_m_ - 1e-12 * length_m_) knots.pop_back();
  knots.insert(knots.end(), 4, to_m_);
  return knots;
}

}  // namespace contour
