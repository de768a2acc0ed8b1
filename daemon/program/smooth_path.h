#pragma once

#include <cstddef>
#include <vector>

#include "core/axis.h"
#include "daemon/program/knot_spacing.h"
#include "daemon/program/programmed_path.h"

namespace contour {

/// Position on a smooth path and its derivatives by the way, up to the third.
struct PathDerivatives {
  PerAxis<double> position_m;
  PerAxis<double> first;
  PerAxis<double> second;  ///< 1/m
  PerAxis<double> third;   ///< 1/m^2, from the right at a knot
};

/// A cubic spline by the programmed way: twice continuously differentiable, its third derivative constant
/// between knots. Straight where its coefficients lie on a straight line.
class SmoothPath {
 public:
  /// A coefficient for every four neighbours among the knots. It goes from the fourth knot to the fourth but
  /// last, which are there four times where the path begins or ends.
  SmoothPath(std::vector<double> knots_m, std::vector<PerAxis<double>> coefficients_m);

  [[nodiscard]] double from_m() const { return knots_[3]; }
  [[nodiscard]] double to_m() const { return knots_[knots_.size() - 4]; }
  [[nodiscard]] std::size_t axis_count() const { return coefficients_.front().size(); }
  /// Pieces between knots, from 0: piece i lies between knot i and i + 1 of breaks.
  [[nodiscard]] std::size_t pieces() const { return knots_.size() - 7; }
  [[nodiscard]] double break_m(std::size_t i) const { return knots_[i + 3]; }
  [[nodiscard]] std::size_t PieceAt(double way_m) const;

  [[nodiscard]] const std::vector<double>& knots_m() const { return knots_; }
  /// From one of its knots to another.
  [[nodiscard]] SmoothPath Between(std::size_t first_knot, std::size_t last_knot) const;

  [[nodiscard]] PerAxis<double> Position(double way_m) const;
  [[nodiscard]] PathDerivatives At(double way_m) const { return At(way_m, PieceAt(way_m)); }
  [[nodiscard]] PathDerivatives At(double way_m, std::size_t piece) const;

 private:
  std::vector<double> knots_;
  std::vector<PerAxis<double>> coefficients_;
};

/// Knots that are decided before the rest of a path is fitted: those of a path that is fitted piece by piece.
struct FixedKnots {
  std::vector<double> knots_m{0.0, 0.0, 0.0, 0.0};
  /// From this one of them on the path may still change, and is looked at.
  std::size_t settled = 3;
};

struct SmoothFit {
  SmoothPath path;
  std::vector<LoneCorner> corners;
};

/// The smooth path through a stretch of moves: starts and ends where they do, is never farther from the
/// programmed path than its tolerance, and as smooth as this allows. A corner between moves that are long
/// enough is rounded by itself, which leaves the rest of them straight. Where moves are shorter than that,
/// the spline goes through their midst, and its knots are as far apart as the tolerance allows. What `path`
/// has before the knots that are fixed has to reach back to the first of them.
SmoothFit SmoothPathThrough(const ProgrammedPath& path, const FixedKnots& fixed = {});

}  // namespace contour
