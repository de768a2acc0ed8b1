#pragma once

#include <vector>

#include "control/control_law.h"
#include "control/flat_feedforward.h"

namespace contour {

/// The drive closes the loop: the target position is the reference, the force is what it will take (sent as
/// torque offset when the drive is configured for it, else zero).
class CspLaw final : public ControlLaw {
 public:
  CspLaw(const CspConfig& config, const ControllerOptions& options, const PerAxis<ControlledAxis>& axes,
         double period_s);
  void Reset() noexcept override;
  void Release(std::size_t) noexcept override {}  // the drive's own cascade goes on holding
  void Soften(Softness softness) noexcept override { share_ = OffsetShare(softness); }
  void Step(const ControlInput& input, ControlOutput& output) noexcept override;
  [[nodiscard]] int horizon_points() const noexcept override { return 5; }
  void Keep(StateKeeper& keep) noexcept override { keep(plan_, share_); }

 private:
  bool torque_offset_;
  double share_ = 1.0;  ///< of the torque offset
  PerAxis<ControlledAxis> axes_;
  std::vector<FlatFeedforward> feedforward_;
  AxisPlan plan_;
};

}  // namespace contour
