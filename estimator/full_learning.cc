#include "estimator/full_learning.h"

#include <cmath>
#include <numbers>

namespace contour {
namespace {

/// Reported torque is coarser than commanded torque is known: each reversal tells less of the screw, and all
/// of them together are farther off.
constexpr double kMostStdInCascade = 0.25;
constexpr double kSameLawInCascade = 0.3;

double Turn_m(const FilterSetup& setup) { return 2.0 * std::numbers::pi * setup.mechanics.radius_m_rad; }

double Rate(const FilterSetup& setup, double rate) { return setup.config.adapt ? rate : 0.0; }

AngleForceMap::Tuning Map(const FilterSetup& setup) {
  // A second difference of the position takes sqrt(1 + 4 + 1) of its noise.
  const double difference_N =
      std::sqrt(6.0) * setup.measurement_std_m * setup.mechanics.mass_kg / (setup.period_s * setup.period_s);
  return {Turn_m(setup), difference_N, Rate(setup, setup.config.cogging_rate), setup.period_s};
}

WindUpFit::Tuning Screw(const FilterSetup& setup) {
  WindUpFit::Tuning screw;
  screw.period_s = setup.period_s;
  // All friction goes into it, and only the table's share winds the screw up.
  screw.stiffness_N_m = setup.mechanics.stiffness_N_m / (1.0 - setup.friction.motor_share);
  screw.before_screw = setup.friction.motor_share;
  screw.stiffness_std = Rate(setup, setup.config.stiffness_std);
  screw.vs_m_s = setup.friction.vs_m_s;
  screw.sigma1_Ns_m = setup.friction.sigma1_Ns_m;
  screw.sigma1_decay_m_s = setup.friction.sigma1_decay_m_s;
  screw.sigma2_Ns_m = setup.friction.sigma2_Ns_m;
  if (setup.reported_torque) {
    screw.most_std = kMostStdInCascade;
    screw.same_law = kSameLawInCascade;
  }
  return screw;
}

}  // namespace

FullLearning::FullLearning(const FilterSetup& s)
    : level(LevelCorrection::Tuning{Turn_m(s), s.friction.vs_m_s, Rate(s, s.config.ripple_rate),
                                    Rate(s, s.config.stribeck_rate), s.period_s}),
      viscous(ViscousCorrection::Tuning{s.friction.sigma2_Ns_m, Rate(s, s.config.viscous_rate), s.period_s}),
      momentum(MomentumBalance::Tuning{s.mechanics.mass_kg, s.period_s, Rate(s, s.config.mass_rate),
                                       Rate(s, s.config.delay_rate)}),
      map(Map(s)),
      wind_up(Screw(s)) {}

void FullLearning::Reset() noexcept {
  level.Reset();
  viscous.Reset();
  momentum.Reset();
  map.Reset();
  wind_up.Reset();
}

}  // namespace contour
