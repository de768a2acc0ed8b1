#include "estimator/kinematic_observer.h"

#include "estimator/gaussian.h"

namespace contour {
namespace {

// The observer knows no covariance: a step of a millimetre in one cycle is no motion of a machine tool.
constexpr double kGate_m = 1e-3;

}  // namespace

AxisEstimate KinematicObserver::Update(const AxisEstimatorInput& in) noexcept {
  const double force_N = in.enabled ? lag_.Step(in.force_N[1])[0] : 0.0;
  if (!in.enabled) lag_.Reset();
  acceleration_m_s2_ += (force_N - mean_force_N_) * inverse_mass_1_kg_;
  mean_force_N_ = force_N;
  position_m_ += period_s_ * (velocity_m_s_ + 0.5 * period_s_ * acceleration_m_s2_);
  velocity_m_s_ += period_s_ * acceleration_m_s2_;
  AxisEstimate out;
  if (in.fresh) {
    out.innovation_m = in.position_m - position_m_;
    if (std::abs(out.innovation_m) <= kGate_m) {
      position_m_ += position_gain_ * out.innovation_m;
      velocity_m_s_ += velocity_gain_ * out.innovation_m;
      acceleration_m_s2_ += acceleration_gain_ * out.innovation_m;
      gated_in_a_row_ = 0;
    } else {
      out.limit = Reason::kInnovationGated;
      if (StartsAgain(++gated_in_a_row_, period_s_)) Reset(in.position_m);
    }
  }
  out.position_m = position_m_;
  out.velocity_m_s = velocity_m_s_;
  const double ahead_N = in.enabled ? lag_.Look(in.force_N[0])[0] : 0.0;
  const double ahead_m_s2 = acceleration_m_s2_ + (ahead_N - mean_force_N_) * inverse_mass_1_kg_;
  out.predicted_position_m = position_m_ + period_s_ * (velocity_m_s_ + 0.5 * period_s_ * ahead_m_s2);
  out.predicted_velocity_m_s = velocity_m_s_ + period_s_ * ahead_m_s2;
  out.diverged = !std::isfinite(position_m_ + velocity_m_s_ + acceleration_m_s2_);
  return out;
}

}  // namespace contour
