#include "daemon/program/path_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contour {
namespace {

constexpr std::size_t kLeaf = 8;    // moves in a box of the lowest level
constexpr std::size_t kBranch = 4;  // boxes in a box

float Below(double x) {
  return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}
float Above(double x) {
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

}  // namespace

PathTree::PathTree(const MoveStore& moves) : moves_(moves), axes_(moves.start_m().size()), levels_(1) {
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const Extent box = ExtentOf(moves.Curve(i));
    i % kLeaf == 0 ? Append(box, levels_[0]) : EnlargeLast(box, levels_[0]);
  }
  while (Count(levels_.size() - 1) > 1) {
    const std::size_t below = levels_.size() - 1;
    levels_.emplace_back();
    for (std::size_t i = 0; i < Count(below); ++i) {
      const Extent box = Box(below, i);
      i % kBranch == 0 ? Append(box, levels_.back()) : EnlargeLast(box, levels_.back());
    }
  }
}

void PathTree::Append(const Extent& box, Boxes& boxes) const {
  for (std::size_t k = 0; k < axes_; ++k) boxes.push_back(Below(box.min_m[k]));
  for (std::size_t k = 0; k < axes_; ++k) boxes.push_back(Above(box.max_m[k]));
}

void PathTree::EnlargeLast(const Extent& box, Boxes& boxes) const {
  float* const least = &boxes[boxes.size() - 2 * axes_];
  for (std::size_t k = 0; k < axes_; ++k) {
    least[k] = std::min(least[k], Below(box.min_m[k]));
    least[axes_ + k] = std::max(least[axes_ + k], Above(box.max_m[k]));
  }
}

Extent PathTree::Box(std::size_t level, std::size_t index) const {
  const float* const least = &levels_[level][index * 2 * axes_];
  Extent box;
  for (std::size_t k = 0; k < axes_; ++k) {
    box.min_m.push_back(static_cast<double>(least[k]));
    box.max_m.push_back(static_cast<double>(least[axes_ + k]));
  }
  return box;
}

void PathTree::Search(std::size_t level, std::size_t index, const PerAxis<double>& point_m,
                      double& nearest_m) const {
  if (DistanceToBox_m(Box(level, index), point_m) >= nearest_m) return;
  if (level == 0) {
    const std::size_t end = std::min(moves_.size(), (index + 1) * kLeaf);
    for (std::size_t i = index * kLeaf; i < end; ++i)
      nearest_m = std::min(nearest_m, contour::Distance_m(moves_.Curve(i), point_m));
    return;
  }
  // The nearest box first: the others are then mostly out of the question.
  const std::size_t begin = index * kBranch;
  const std::size_t end = std::min(Count(level - 1), begin + kBranch);
  std::size_t first = begin;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = begin; i < end; ++i) {
    const double distance = DistanceToBox_m(Box(level - 1, i), point_m);
    if (distance < least) {
      least = distance;
      first = i;
    }
  }
  Search(level - 1, first, point_m, nearest_m);
  for (std::size_t i = begin; i < end; ++i)
    if (i != first) Search(level - 1, i, point_m, nearest_m);
}

double PathTree::Distance_m(const PerAxis<double>& point_m) const {
  double nearest = std::numeric_limits<double>::infinity();
  if (!moves_.empty()) Search(levels_.size() - 1, 0, point_m, nearest);
  return nearest;
}

}  // namespace contour
