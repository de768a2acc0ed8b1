#include "daemon/program/stretch_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace contour {
namespace {

constexpr double kScoredAfter_s = 1.0;

}  // namespace

StretchPlan::StretchPlan(StretchProgram program)
    : program_(std::make_shared<const StretchProgram>(std::move(program))), walk_(program_) {}

double StretchPlan::duration_s() const {
  const std::lock_guard lock(mutex_);
  return walk_.duration_s();
}

std::uint32_t StretchPlan::Line(double time_s) const {
  const std::lock_guard lock(mutex_);
  return static_cast<std::uint32_t>(std::max(0, walk_.Line(time_s)));
}

std::uint32_t StretchPlan::Halts(double time_s) const {
  const std::lock_guard lock(mutex_);
  return walk_.Halts(time_s);
}

void StretchPlan::At(double time_s, PerAxis<ReferencePoint>& axes) const {
  const std::lock_guard lock(mutex_);
  walk_.At(time_s, axes);
}

double StretchPlan::Distance_m(const PerAxis<double>& point_m) const {
  if (!is_hold()) {
    std::call_once(tree_made_, [this] { tree_ = std::make_unique<const PathTree>(program_->moves()); });
    return tree_->Distance_m(point_m);
  }
  double squared = 0.0;
  for (std::size_t i = 0; i < point_m.size(); ++i)
    squared += std::pow(point_m[i] - program_->start_m()[i], 2);
  return std::sqrt(squared);
}

bool StretchPlan::Scored(double time_s) const {
  return time_s >= kScoredAfter_s && (GoesOnAfter(time_s) || time_s <= duration_s());
}

bool StretchPlan::Moves(std::size_t axis) const {
  return program_->box().max_m[axis] > program_->box().min_m[axis];
}

bool StretchPlan::GoesOnAfter(double time_s) const {
  const std::lock_guard lock(mutex_);
  return walk_.GoesOnAfter(time_s);
}

std::unique_ptr<PathWalk> StretchPlan::Walk() const { return std::make_unique<StretchWalk>(program_); }

}  // namespace contour
