#pragma once

#include <cstddef>
#include <vector>

#include "core/axis.h"
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
  /// Knots with the first and the last one four times; a coefficient for every four neighbours.
  SmoothPath(std::vector<double> knots_m, std::vector<PerAxis<double>> coefficients_m);

  [[nodiscard]] double length_m() const { return knots_.back(); }
  [[nodiscard]] std::size_t axis_count() const { return coefficients_.front().size(); }
  /// Pieces between knots, from 0: piece i lies between knot i and i + 1 of breaks.
  [[nodiscard]] std::size_t pieces() const { return knots_.size() - 7; }
  [[nodiscard]] double break_m(std::size_t i) const { return knots_[i + 3]; }
  [[nodiscard]] std::size_t PieceAt(double way_m) const;

  [[nodiscard]] PerAxis<double> Position(double way_m) const;
  [[nodiscard]] PathDerivatives At(double way_m) const { return At(way_m, PieceAt(way_m)); }
  [[nodiscard]] PathDerivatives At(double way_m, std::size_t piece) const;

 private:
  std::vector<double> knots_;
  std::vector<PerAxis<double>> coefficients_;
};

/// The smooth path through a stretch of moves: starts and ends where they do, is never farther from the
/// programmed path than its tolerance, and as smooth as this allows. A corner between moves that are long
/// enough is rounded by itself, which leaves the rest of them straight. Where moves are shorter than that,
/// the spline goes through their midst, and its knots are as far apart as the tolerance allows.
SmoothPath SmoothPathThrough(const ProgrammedPath& path);

}  // namespace contour
