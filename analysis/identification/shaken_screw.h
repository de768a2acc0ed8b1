#pragma once

#include <string>
#include <vector>

#include "analysis/identification/joint_fit.h"
#include "analysis/identification/screw_response.h"

namespace contour::identify {

/// A screw whose resonance is higher is none: the axis counts as rigid.
inline constexpr double kRigidFrom_Hz = 900.0;

/// The segments in which the axis slides at a steady speed while torque shakes it quickly, each with a run-up
/// of the rows before it: what swings on the table does so from before.
std::vector<Measured> ShakenStretches(const std::vector<Measured>& records, const TableAxis& axis);

/// What shaking the sliding axis tells of its screw, on the time series: there the bristle is saturated, and
/// nothing depends on when exactly the axis came to rest.
struct ShakenScrew {
  enum class Verdict {
    kNotSeen,  ///< see why_not
    kFound,
    kRigid,  ///< its resonance is beyond what the shaking shows
  };
  Verdict verdict = Verdict::kNotSeen;
  std::string why_not;
  TableAxis axis;        ///< as found; kRigid: one mass
  double seconds = 0.0;  ///< of shaken sliding
  double highest_Hz = 0.0;
  double antiresonance_Hz = 0.0,
         resonance_Hz = 0.0;  ///< kFound: K = Mt (2 pi f_ar)^2, (f_r / f_ar)^2 = m / m_motor
  double moves_m = 0.0;  ///< kFound: by how much a rigid axis would have been shaken at the antiresonance
  std::vector<ResponsePoint> response;
  std::vector<FittedParameter> parameters;  ///< as the shaken segments alone say
};

/// Two masses from every antiresonance that the shaking could show and several shares of the table, the best
/// of them refined with delay, lag and friction; against one mass.
ShakenScrew FitShakenScrew(const TableAxis& start, const std::vector<Measured>& records, int threads = 1);

}  // namespace contour::identify
