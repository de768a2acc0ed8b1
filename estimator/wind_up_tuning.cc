#include "estimator/wind_up_tuning.h"

#include <algorithm>

namespace contour {
namespace {

/// Reported torque is coarser than commanded torque is known.
struct CascadeTuning {
  double most_std = 0.25;  ///< each reversal tells less of the screw
  double same_law = 0.3;   ///< and all of them together are farther off
  /// By a torque that noisy another kind of friction may pass for a screw of half the stiffness. More only
  /// where what is stated is less sure.
  double most_change = 0.3;
  double most_change_stds = 4.0;
};
constexpr CascadeTuning kCascade;

}  // namespace

// All friction goes into the fit, and only the table's share winds the screw up: what it finds is 1 / K less
// the motor's share.
WindUpFit::Tuning WindUpTuning(const FilterSetup& s) {
  WindUpFit::Tuning t;
  t.period_s = s.period_s;
  t.stiffness_N_m = s.mechanics.stiffness_N_m / (1.0 - s.friction.motor_share);
  t.before_screw = s.friction.motor_share;
  t.stiffness_std = s.config.adapt ? s.config.stiffness_std : 0.0;
  t.vs_m_s = s.friction.vs_m_s;
  t.sigma1_Ns_m = s.friction.sigma1_Ns_m;
  t.sigma1_decay_m_s = s.friction.sigma1_decay_m_s;
  t.sigma2_Ns_m = s.friction.sigma2_Ns_m;
  if (s.reported_torque) {
    t.most_std = kCascade.most_std;
    t.same_law = kCascade.same_law;
    t.most_change = std::max(kCascade.most_change, kCascade.most_change_stds * t.stiffness_std);
  }
  return t;
}

}  // namespace contour
