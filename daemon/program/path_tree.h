#pragma once

#include <cstddef>
#include <vector>

#include "daemon/program/curve_piece.h"
#include "daemon/program/programmed_path.h"

namespace contour {

/// Boxes around moves, around pairs of boxes and so on: finds the nearest of many moves without trying all.
class PathTree {
 public:
  /// The moves stay where they are.
  explicit PathTree(const std::vector<ProgrammedMove>& moves);

  /// From a point to the nearest move; infinite without moves.
  [[nodiscard]] double Distance_m(const PerAxis<double>& point_m) const;
  /// Around everything.
  [[nodiscard]] const Extent& box() const { return levels_.back().front(); }
  [[nodiscard]] bool empty() const { return moves_.empty(); }

 private:
  void Search(std::size_t level, std::size_t index, const PerAxis<double>& point_m, double& nearest_m) const;

  const std::vector<ProgrammedMove>& moves_;
  std::vector<std::vector<Extent>> levels_;
};

}  // namespace contour
