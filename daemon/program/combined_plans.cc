#include "daemon/program/combined_plans.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contour {

SequencePlan::SequencePlan(Plans plans) : plans_(std::move(plans)), begin_s_{0.0} {
  for (const auto& plan : plans_) begin_s_.push_back(begin_s_.back() + plan->duration_s());
}

void SequencePlan::At(double time_s, PerAxis<ReferencePoint>& axes) const {
  const auto after = std::upper_bound(begin_s_.begin(), begin_s_.end(), time_s);
  const auto index = static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, after - begin_s_.begin())) - 1;
  const std::size_t plan = std::min(index, plans_.size() - 1);
  plans_[plan]->At(time_s - begin_s_[plan], axes);
}

double SequencePlan::Distance_m(const PerAxis<double>& point_m) const {
  double nearest = std::numeric_limits<double>::infinity();
  const MotionPlan* last = nullptr;
  for (const auto& plan : plans_) {
    if (plan.get() != last) nearest = std::min(nearest, plan->Distance_m(point_m));
    last = plan.get();
  }
  return nearest;
}

bool SequencePlan::is_hold() const {
  return std::all_of(plans_.begin(), plans_.end(), [](const auto& p) { return p->is_hold(); });
}

bool SequencePlan::Moves(std::size_t axis) const {
  return std::any_of(plans_.begin(), plans_.end(), [&](const auto& p) { return p->Moves(axis); });
}

TogetherPlan::TogetherPlan(SequencePlan::Plans plans, const PerAxis<PlanLimits>& limits,
                           const std::string& origin)
    : plans_(std::move(plans)), mover_(limits.size()) {
  for (const auto& plan : plans_) duration_s_ = std::max(duration_s_, plan->duration_s());
  for (std::size_t axis = 0; axis < limits.size(); ++axis) {
    mover_[axis] = 0;
    std::size_t movers = 0;
    for (std::size_t i = 0; i < plans_.size(); ++i) {
      if (!plans_[i]->Moves(axis)) continue;
      mover_[axis] = i;
      ++movers;
    }
    if (movers > 1)
      throw ProgramError(origin + ": together: axis " + limits[axis].axis + " is moved by two parts at once");
  }
}

void TogetherPlan::At(double time_s, PerAxis<ReferencePoint>& axes) const {
  axes.resize(axis_count());
  PerAxis<ReferencePoint> part;
  for (std::size_t i = 0; i < plans_.size(); ++i) {
    plans_[i]->At(time_s, part);
    for (std::size_t axis = 0; axis < axes.size(); ++axis)
      if (mover_[axis] == i) axes[axis] = part[axis];
  }
}

double TogetherPlan::Distance_m(const PerAxis<double>& point_m) const {
  // Every part has a figure of its own in its own axes: what they draw together is the product of all of
  // them.
  PerAxis<ReferencePoint> at_rest;
  At(0.0, at_rest);
  double squared = 0.0;
  for (std::size_t i = 0; i < plans_.size(); ++i) {
    PerAxis<double> on_its_axes = point_m;
    for (std::size_t axis = 0; axis < point_m.size(); ++axis)
      if (mover_[axis] != i) on_its_axes[axis] = at_rest[axis].position_m;
    squared += std::pow(plans_[i]->Distance_m(on_its_axes), 2);
  }
  return std::sqrt(squared);
}

bool TogetherPlan::is_hold() const {
  return std::all_of(plans_.begin(), plans_.end(), [](const auto& p) { return p->is_hold(); });
}

bool TogetherPlan::Moves(std::size_t axis) const { return plans_[mover_[axis]]->Moves(axis); }

}  // namespace contour
