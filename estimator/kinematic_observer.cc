#include "estimator/kinematic_observer.h"

namespace contour {

AxisEstimate KinematicObserver::Update(const AxisEstimatorInput& in) noexcept {
  position_m_ += period_s_ * (velocity_m_s_ + 0.5 * period_s_ * acceleration_m_s2_);
  velocity_m_s_ += period_s_ * acceleration_m_s2_;
  AxisEstimate out;
  if (in.fresh) {
    out.innovation_m = in.position_m - position_m_;
    position_m_ += position_gain_ * out.innovation_m;
    velocity_m_s_ += velocity_gain_ * out.innovation_m;
    acceleration_m_s2_ += acceleration_gain_ * out.innovation_m;
  }
  out.position_m = position_m_;
  out.velocity_m_s = velocity_m_s_;
  out.predicted_position_m = position_m_ + period_s_ * (velocity_m_s_ + 0.5 * period_s_ * acceleration_m_s2_);
  out.predicted_velocity_m_s = velocity_m_s_ + period_s_ * acceleration_m_s2_;
  out.diverged = !std::isfinite(position_m_ + velocity_m_s_ + acceleration_m_s2_);
  return out;
}

}  // namespace contour
