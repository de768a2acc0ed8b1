#pragma once

#include <cstddef>
#include <vector>

#include "daemon/program/move_store.h"

namespace contour {

/// Boxes around moves, around groups of boxes and so on: finds the nearest of many moves without trying all.
/// One byte for each move and axis.
class PathTree {
 public:
  /// The moves stay where they are.
  explicit PathTree(const MoveStore& moves);

  /// From a point to the nearest move; infinite without moves.
  [[nodiscard]] double Distance_m(const PerAxis<double>& point_m) const;

 private:
  /// Lower and upper ends on every axis, rounded outwards.
  using Boxes = std::vector<float>;
  void Append(const Extent& box, Boxes& boxes) const;
  void EnlargeLast(const Extent& box, Boxes& boxes) const;
  [[nodiscard]] Extent Box(std::size_t level, std::size_t index) const;
  [[nodiscard]] std::size_t Count(std::size_t level) const { return levels_[level].size() / (2 * axes_); }
  void Search(std::size_t level, std::size_t index, const PerAxis<double>& point_m, double& nearest_m) const;

  const MoveStore& moves_;
  std::size_t axes_;
  std::vector<Boxes> levels_;
};

}  // namespace contour
