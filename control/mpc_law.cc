#include "control/mpc_law.h"

namespace contour {

MpcLaw::MpcLaw(const MpcConfig& config, const ControllerOptions& options, const PerAxis<ControlledAxis>& axes,
               double period_s)
    : horizon_points_(config.horizon + 3) {
  const std::size_t count = axes.size();
  if (count == 3) {
    groups_.push_back(std::make_unique<MpcGroup<3>>(config, options, axes, 0, period_s));
    return;
  }
  std::size_t first = 0;
  for (; first + 2 <= count; first += 2) {
    groups_.push_back(std::make_unique<MpcGroup<2>>(config, options, axes, first, period_s));
  }
  if (first < count) groups_.push_back(std::make_unique<MpcGroup<1>>(config, options, axes, first, period_s));
}

void MpcLaw::Reset() noexcept {
  for (auto& group : groups_) group->Reset();
}

void MpcLaw::Soften(Softness softness) noexcept {
  for (auto& group : groups_) group->Soften(softness != Softness::kNone);
}

void MpcLaw::Step(const ControlInput& input, ControlOutput& output) noexcept {
  output.iterations = 0;
  for (auto& group : groups_) group->Step(input, output);
}

}  // namespace contour
