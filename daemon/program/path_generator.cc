#include "daemon/program/path_generator.h"

#include <cmath>

namespace contour {

PathGenerator::PathGenerator(const Program& program, const PerAxis<double>& start_m,
                             const PerAxis<PlanLimits>& limits, double period_s, std::uint32_t program_id)
    : PathGenerator(PlanMotion(program, start_m, limits), limits, period_s, program_id) {}

PathGenerator::PathGenerator(std::shared_ptr<const MotionPlan> plan, const PerAxis<PlanLimits>& limits,
                             double period_s, std::uint32_t program_id)
    : plan_(std::move(plan)), limits_(limits), period_s_(period_s), program_id_(program_id) {}

std::uint64_t PathGenerator::PeriodsIn(double time_s) const {
  return static_cast<std::uint64_t>(std::ceil(time_s / period_s_ - kRounding));
}

std::uint64_t PathGenerator::points() const { return PeriodsIn(plan_->duration_s()) + 1; }

bool PathGenerator::Next(PathPoint& point) {
  if (done_) return false;
  point.program_id = program_id_;
  point.last = !plan_->GoesOnAfter((static_cast<double>(next_) + kRounding) * period_s_);
  done_ = point.last;
  // The last grid point lies on the end of the path or after it.
  const double time_s = point.last ? plan_->duration_s() : static_cast<double>(next_) * period_s_;
  plan_->At(time_s, point.axes);
  if (offsets_) offsets_->AddTo(next_, point);
  ++next_;
  return true;
}

}  // namespace contour
