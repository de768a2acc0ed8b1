#pragma once

#include <vector>

#include "daemon/program/programmed_path.h"

namespace contour {

/// A corner between straight moves that are long enough for it to be rounded by itself. With the way s from
/// the corner, a the mean of the two directions and b half their difference, the programmed path is a s + b
/// |s|, and the smooth one a s + b g(s): g'' is the sum of two triangles about the corner, a wide and a
/// narrow one, because the corner itself is passed slowest. That is a cubic spline with five knots whose
/// coefficients lie on the moves but for the one in the middle.
struct LoneCorner {
  double at_m = 0.0;
  double outer_m = 0.0;  ///< to the knots next to it, of way
  double inner_m = 0.0;
  PerAxis<double> pull_m;  ///< of the coefficient in the middle, from the corner inwards
};

/// How far apart the knots of a smooth path may be along a programmed one. Where the path bends by itself
/// (arcs, corners between moves that are short for the tolerance) this is a guess that whoever fits the path
/// corrects.
class KnotSpacing {
 public:
  /// `fixed`: knots that are there already.
  KnotSpacing(const ProgrammedPath& path, const std::vector<double>& fixed);

  [[nodiscard]] const std::vector<LoneCorner>& corners() const { return corners_; }

  /// Those that are fixed and more of them to the end, lone corners in the middle of five.
  [[nodiscard]] std::vector<double> Knots() const;

  /// Largest change of the unit tangent at one of the junctions before..end of moves.
  [[nodiscard]] double LargestTurn(std::size_t before, std::size_t end) const;

  /// To be multiplied by `factor` near this way, when Shrink() is called; the smallest factor counts.
  void Note(double way_m, double reach_m, double factor);
  void Shrink();

 private:
  struct Control {
    double at_m = 0.0;
    double spacing_m = 0.0;
    double factor = 1.0;
  };
  [[nodiscard]] bool AddLone(const ProgrammedPath& path, std::size_t before, const PerAxis<double>& change);
  void GoOnFromFixed();
  void AddControl(double at_m, double spacing_m) {
    if (at_m > fixed_.back()) controls_.push_back({at_m, spacing_m});
  }
  void AddJunction(const ProgrammedPath& path, std::size_t before);
  void AddArc(const ProgrammedPath& path, std::size_t move);
  void LimitSlope();
  void Fill(double from_m, double to_m, std::size_t& control, std::vector<double>& knots) const;

  const std::vector<double>& fixed_;
  double to_m_;
  double length_m_;
  std::vector<double> turns_;  ///< change of the unit tangent after each move
  std::vector<LoneCorner> corners_;
  std::vector<Control> controls_;  ///< in order of way
};

}  // namespace contour
