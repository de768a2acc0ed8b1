#include "daemon/program/path_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contour {
namespace {

constexpr std::size_t kLeaf = 4;    // moves in a box of the lowest level
constexpr std::size_t kBranch = 4;  // boxes in a box

}  // namespace

PathTree::PathTree(const std::vector<ProgrammedMove>& moves) : moves_(moves), levels_(1) {
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const Extent box = ExtentOf(moves[i].curve);
    if (i % kLeaf == 0) {
      levels_[0].push_back(box);
    } else {
      Enlarge(levels_[0].back(), box);
    }
  }
  while (levels_.back().size() > 1) {
    std::vector<Extent> above;
    const std::vector<Extent>& below = levels_.back();
    for (std::size_t i = 0; i < below.size(); ++i) {
      if (i % kBranch == 0) {
        above.push_back(below[i]);
      } else {
        Enlarge(above.back(), below[i]);
      }
    }
    levels_.push_back(std::move(above));
  }
}

void PathTree::Search(std::size_t level, std::size_t index, const PerAxis<double>& point_m,
                      double& nearest_m) const {
  if (DistanceToBox_m(levels_[level][index], point_m) >= nearest_m) return;
  if (level == 0) {
    const std::size_t end = std::min(moves_.size(), (index + 1) * kLeaf);
    for (std::size_t i = index * kLeaf; i < end; ++i)
      nearest_m = std::min(nearest_m, contour::Distance_m(moves_[i].curve, point_m));
    return;
  }
  // The nearest box first: the others are then mostly out of the question.
  const std::size_t begin = index * kBranch;
  const std::size_t end = std::min(levels_[level - 1].size(), begin + kBranch);
  std::size_t first = begin;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = begin; i < end; ++i) {
    const double distance = DistanceToBox_m(levels_[level - 1][i], point_m);
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
