#pragma once

#include "estimator/filter_setup.h"
#include "estimator/wind_up_fit.h"

namespace contour {

/// Of a screw, with one standard deviation.
struct ScrewStiffness {
  double N_m = 0.0;
  double std_N_m = 0.0;

  /// By a compliance and its standard deviation, in m/N.
  static ScrewStiffness Of(double compliance_m_N, double std_m_N) noexcept {
    const double N_m = 1.0 / compliance_m_N;
    return {N_m, N_m * N_m * std_m_N};
  }
};

/// As reversals have told it; where nothing is learnt, as commissioned with that relative deviation.
/// `before_screw`: share of the friction that acts there.
inline ScrewStiffness StiffnessBy(const WindUpFit& fit, double before_screw,
                                  double commissioned_std) noexcept {
  const double N_m = (1.0 - before_screw) / fit.compliance_m_N();
  return {N_m, N_m * (fit.learns() ? fit.compliance_std_m_N() / fit.compliance_m_N() : commissioned_std)};
}

/// What reversals may tell of an axis's screw, for every estimator that learns from them.
WindUpFit::Tuning WindUpTuning(const FilterSetup& setup);

}  // namespace contour
