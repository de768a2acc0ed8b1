#pragma once

#include <memory>
#include <vector>

#include "control/mpc_group.h"

namespace contour {

/// MPC contour controller of all axes. Up to three axes form one problem, coupled by the path; more are taken
/// in pairs in the order of the machine file, so that cost grows with the number of pairs only.
class MpcLaw final : public ControlLaw {
 public:
  MpcLaw(const MpcConfig& config, const ControllerOptions& options, const PerAxis<ControlledAxis>& axes,
         double period_s);
  void Reset() noexcept override;
  void Release(std::size_t) noexcept override {}  // has no integrator
  void Soften(Softness softness) noexcept override;
  void Step(const ControlInput& input, ControlOutput& output) noexcept override;
  [[nodiscard]] int horizon_points() const noexcept override { return horizon_points_; }
  void Keep(StateKeeper& keep) noexcept override { keep(groups_); }

 private:
  std::vector<std::unique_ptr<MpcGroupBase>> groups_;
  int horizon_points_;
};

}  // namespace contour
