#include "estimator/full_learning.h"

#include <numbers>

#include "estimator/angle_force_tuning.h"
#include "estimator/wind_up_tuning.h"

namespace contour {
namespace {

double Turn_m(const FilterSetup& setup) { return 2.0 * std::numbers::pi * setup.mechanics.radius_m_rad; }

double Rate(const FilterSetup& setup, double rate) { return setup.config.adapt ? rate : 0.0; }

}  // namespace

FullLearning::FullLearning(const FilterSetup& s)
    : level(LevelCorrection::Tuning{Turn_m(s), s.friction.vs_m_s, Rate(s, s.config.ripple_rate),
                                    Rate(s, s.config.stribeck_rate), s.period_s}),
      viscous(ViscousCorrection::Tuning{s.friction.sigma2_Ns_m, Rate(s, s.config.viscous_rate), s.period_s}),
      momentum(MomentumBalance::Tuning{s.mechanics.mass_kg, s.period_s, Rate(s, s.config.mass_rate),
                                       Rate(s, s.config.delay_rate)}),
      map(AngleForceTuning(s)),
      wind_up(WindUpTuning(s)) {}

void FullLearning::Reset() noexcept {
  level.Reset();
  viscous.Reset();
  momentum.Reset();
  map.Reset();
  wind_up.Reset();
}

}  // namespace contour
