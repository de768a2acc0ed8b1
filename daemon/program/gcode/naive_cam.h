#pragma once

#include <vector>

#include "daemon/program/gcode/canonical_move.h"

namespace contour {

/// LinuxCNC's naive CAM detector, G64 Q: straight moves along X Y Z at one feed become a single one as long
/// as no point between its ends is farther than Q from it, 101 points at most.
class NaiveCam {
 public:
  /// Does the line that ends at `from_m` become longer, to where `move` ends? A line begins there otherwise.
  bool Joins(const AxisValues& from_m, const GcodeMove& move, double within_m);
  /// What comes now begins a line of its own.
  void Break() { points_m_.clear(); }

 private:
  [[nodiscard]] bool Fits(const AxisValues& end_m, double within_m) const;

  AxisValues begin_m_{};
  std::vector<AxisValues> points_m_;  ///< ends of its moves
  GcodeMove newest_;
};

}  // namespace contour
