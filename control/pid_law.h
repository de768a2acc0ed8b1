#pragma once

#include "control/control_law.h"

namespace contour {

/// PID on the motor position with feed-forward of velocity and acceleration. Gains follow from the rigid
/// mass: bandwidth and damping set position and velocity gain, integral_Hz the corner below which the
/// integral works. The integral stops while the force is limited and the error would drive it further
/// (conditional integration).
class PidLaw final : public ControlLaw {
 public:
  PidLaw(const PidConfig& config, const ControllerOptions& options, const PerAxis<ControlledAxis>& axes,
         double period_s);
  void Reset() noexcept override;
  void Release(std::size_t axis) noexcept override { memory_[axis] = AxisMemory{}; }
  void Soften(Softness softness) noexcept override {
    gain_share_ = softness == Softness::kNone ? 1.0 : options_.softer;
  }
  void Step(const ControlInput& input, ControlOutput& output) noexcept override;
  [[nodiscard]] int horizon_points() const noexcept override { return 2; }
  void Keep(StateKeeper& keep) noexcept override { keep(memory_, gain_share_); }

 private:
  struct AxisGains {
    double mass_kg = 0.0;
    double viscous_Ns_m = 0.0;
    double proportional_N_m = 0.0;
    double derivative_Ns_m = 0.0;
    double force_N = 0.0;
    double step_N = 0.0;
  };
  struct AxisMemory {
    double integral_N = 0.0;
    double position_error_m = 0.0;
    double velocity_error_m_s = 0.0;
    bool has_error = false;
  };

  ControllerOptions options_;
  double gain_share_ = 1.0;  ///< of the bandwidth
  double period_s_;
  double integral_1_s_;
  double filter_;  ///< share of the old value in the velocity filter
  PerAxis<AxisGains> gains_;
  PerAxis<AxisMemory> memory_;
};

}  // namespace contour
