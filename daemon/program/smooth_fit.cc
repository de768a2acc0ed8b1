#include <algorithm>
#include <cmath>

#include "daemon/program/knot_spacing.h"
#include "daemon/program/smooth_path.h"

namespace contour {
namespace {

// By how much spacing is corrected at once, and how often. It goes on until the path is within its tolerance.
constexpr double kLeastFactor = 0.5;
constexpr double kMostFactor = 0.9;
constexpr int kRounds = 60;
constexpr int kLooks = 10;  // places on a piece
// By how much a piece may turn (rad) when single moves turn by less than this share of it.
constexpr double kTurnOfPiece = 0.15;
constexpr double kSmoothShare = 0.3;
constexpr double kAim =
    0.97;  // of the tolerance; between the places that are looked at it may be a little more
// Where the knots were decided with other ones behind them. Those are corrected for it a few times only.
constexpr double kAimAtFixed = 0.985;
constexpr int kRoundsAtFixed = 8;

double Distance_m(const PerAxis<double>& a, const PerAxis<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

/// What a coefficient is made of: a mean of the programmed path about its place.
struct Sample {
  double at_m = 0.0;
  double variance_m2 = 0.0;  ///< of spline and mean together: what curvature they take off
  const LoneCorner* corner = nullptr;
  PerAxis<double> mean_m;
};

const LoneCorner* CornerAt(const std::vector<LoneCorner>& corners, std::size_t& next, double middle_m) {
  while (next < corners.size() && corners[next].at_m < middle_m) ++next;
  return next < corners.size() && corners[next].at_m == middle_m ? &corners[next] : nullptr;
}

/// Coefficients of the spline that reproduces straight lines exactly, and curves to the fourth order of the
/// knots' distance: means of the path less what spline and mean take off its curvature. A lone corner has
/// coefficients on its moves and one inside.
std::vector<PerAxis<double>> Coefficients(const ProgrammedPath& path, const std::vector<double>& knots,
                                          const std::vector<LoneCorner>& corners) {
  const std::size_t count = knots.size() - 4;
  std::vector<Sample> samples(count);
  std::size_t corner = 0;
  for (std::size_t j = 0; j < count; ++j) {
    const double a = knots[j + 1], b = knots[j + 2], c = knots[j + 3];
    Sample& s = samples[j];
    s.corner = CornerAt(corners, corner, b);
    s.at_m = s.corner != nullptr ? b : (a + b + c) / 3.0;
    const double half_m = s.corner != nullptr ? 0.0 : 0.25 * (c - a);
    s.mean_m = half_m > 0.0 ? path.Mean(s.at_m - half_m, s.at_m + half_m) : path.At(s.at_m);
    s.variance_m2 =
        ((a - b) * (a - b) + (a - c) * (a - c) + (b - c) * (b - c)) / 18.0 + half_m * half_m / 3.0;
  }
  std::vector<PerAxis<double>> coefficients(count);
  for (std::size_t j = 0; j < count; ++j) {
    const Sample& s = samples[j];
    coefficients[j] = s.mean_m;
    if (s.corner != nullptr)
      for (std::size_t i = 0; i < s.mean_m.size(); ++i) coefficients[j][i] += s.corner->pull_m[i];
    if (s.corner != nullptr || j == 0 || j + 1 == count) continue;
    const Sample& before = samples[j - 1];
    const Sample& after = samples[j + 1];
    for (std::size_t i = 0; i < s.mean_m.size(); ++i) {
      const double slope_in = (s.mean_m[i] - before.mean_m[i]) / (s.at_m - before.at_m);
      const double slope_out = (after.mean_m[i] - s.mean_m[i]) / (after.at_m - s.at_m);
      coefficients[j][i] -= s.variance_m2 * (slope_out - slope_in) / (after.at_m - before.at_m);
    }
  }
  return coefficients;
}

/// A spline lies between the smallest and the largest of its coefficients: with all of them within the axes'
/// travel, so is the path.
void KeepWithin(const Extent& travel, std::vector<PerAxis<double>>& coefficients) {
  for (PerAxis<double>& c : coefficients)
    for (std::size_t i = 0; i < c.size(); ++i) c[i] = std::clamp(c[i], travel.min_m[i], travel.max_m[i]);
}

/// Looks at every piece between knots, and notes where knots have to be closer.
class Inspection {
 public:
  Inspection(const ProgrammedPath& path, const SmoothPath& smooth, KnotSpacing& spacing, double fixed_to_m)
      : path_(path), smooth_(smooth), spacing_(spacing), fixed_to_m_(fixed_to_m) {}

  /// Is the spline near enough everywhere from a piece on?
  bool GoodFrom(std::size_t first_piece) {
    std::size_t corner = 0;
    std::size_t move = 0;
    const auto& corners = spacing_.corners();
    for (std::size_t piece = first_piece; piece < smooth_.pieces(); ++piece) {
      const double from = smooth_.break_m(piece), to = smooth_.break_m(piece + 1);
      const double middle = 0.5 * (from + to);
      while (corner < corners.size() && corners[corner].at_m + corners[corner].outer_m < middle) ++corner;
      const bool lone = corner < corners.size() && middle > corners[corner].at_m - corners[corner].outer_m;
      while (move + 1 < path_.size() && path_.begin_m(move + 1) <= from) ++move;
      if (!lone) Look(piece, move);
    }
    return good_;
  }

 private:
  void Look(std::size_t piece, std::size_t move) {
    const double from = smooth_.break_m(piece), to = smooth_.break_m(piece + 1);
    for (int k = 1; k <= kLooks; ++k) LookAt(from + k * (1.0 / kLooks) * (to - from), piece);
    std::size_t end = move;
    for (; end + 1 < path_.size() && path_.begin_m(end + 1) < to; ++end)
      if (path_.begin_m(end + 1) > from) LookAt(path_.begin_m(end + 1), piece);
    if (end == move || from < fixed_to_m_) return;
    // Moves that follow a curve by small turns: the spline shall follow the curve.
    const PathDerivatives q = smooth_.At(0.5 * (from + to), piece);
    double squared = 0.0;
    for (const double x : q.second) squared += x * x;
    const double turn = std::sqrt(squared) * (to - from);
    if (turn <= kTurnOfPiece || spacing_.LargestTurn(move, end) > kSmoothShare * turn) return;
    good_ = false;
    spacing_.Note(0.5 * (from + to), to - from, std::max(kLeastFactor, 0.9 * kTurnOfPiece / turn));
  }

  void LookAt(double way_m, std::size_t piece) {
    const double allowed = (way_m <= fixed_to_m_ ? kAimAtFixed : kAim) * path_.Tolerance_m(way_m);
    const double off = Distance_m(smooth_.At(way_m, piece).position_m, path_.At(way_m));
    if (off <= allowed) return;
    good_ = false;
    const double width = smooth_.break_m(piece + 1) - smooth_.break_m(piece);
    const double factor = std::clamp(0.95 * std::pow(allowed / off, 0.6), kLeastFactor, kMostFactor);
    spacing_.Note(way_m, 2.0 * width, factor);
  }

  const ProgrammedPath& path_;
  const SmoothPath& smooth_;
  KnotSpacing& spacing_;
  double fixed_to_m_;
  bool good_ = true;
};

}  // namespace

SmoothFit SmoothPathThrough(const ProgrammedPath& path, const FixedKnots& fixed) {
  KnotSpacing spacing(path, fixed.knots_m);
  const double fixed_to_m = fixed.knots_m.back();
  for (int round = 0;; ++round) {
    std::vector<double> knots = spacing.Knots();
    std::vector<PerAxis<double>> coefficients = Coefficients(path, knots, spacing.corners());
    if (path.travel()) KeepWithin(*path.travel(), coefficients);
    SmoothPath smooth(std::move(knots), std::move(coefficients));
    const std::size_t first = (round < kRoundsAtFixed ? fixed.settled : fixed.knots_m.size() - 1) - 3;
    if (round == kRounds || Inspection(path, smooth, spacing, fixed_to_m).GoodFrom(first))
      return {std::move(smooth), spacing.corners()};
    spacing.Shrink();
  }
}

}  // namespace contour
