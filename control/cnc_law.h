#pragma once

#include <vector>

#include "control/cnc_config.h"
#include "control/control_law.h"

namespace contour {

/// A numerical control as it is sold: the drive closes the loop, and the control adds what was set once, by a
/// circle test. Lost motion turns round with the direction of motion over a travel, and so does a torque;
/// a pulse of torque helps over the reversal. Nothing is measured and nothing learnt.
class CncLaw final : public ControlLaw {
 public:
  /// Throws std::invalid_argument when an axis lacks the screw's stiffness.
  CncLaw(const CncConfig& config, const PerAxis<ControlledAxis>& axes, double period_s);
  void Reset() noexcept override;
  void Release(std::size_t) noexcept override {}  // the drive's own cascade goes on holding
  void Soften(Softness softness) noexcept override { share_ = OffsetShare(softness); }
  void Step(const ControlInput& input, ControlOutput& output) noexcept override;
  [[nodiscard]] int horizon_points() const noexcept override { return 5; }
  void Keep(StateKeeper& keep) noexcept override;

 private:
  /// How far each compensation has turned round, from -1 to 1, and the reference they have seen.
  struct Turned {
    double lost_motion = 0.0;
    double friction = 0.0;
    double pulse = 0.0;
    double direction = 0.0;  ///< of the last motion
    double target_m = 0.0;
    double torque_m = 0.0;
    bool begun = false;
  };

  void Follow(const ControlledAxis& axis, double target_m, double torque_m, Turned& turned) const noexcept;
  /// Reference at t(k) and a lead.
  [[nodiscard]] ReferencePoint Ahead(const AxisHorizon& reference) const noexcept;

  CncConfig config_;
  PerAxis<ControlledAxis> axes_;
  double lead_cycles_;
  double pulse_kept_;   ///< per cycle
  double share_ = 1.0;  ///< of the torque offset
  std::vector<Turned> turned_;
};

}  // namespace contour
