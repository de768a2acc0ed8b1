#pragma once

#include <complex>
#include <vector>

#include "tools/validation/emps/free_run.h"

namespace contour::emps {

/// What a force model has in addition to mass, viscous and Coulomb friction and a constant force.
struct ForceTerms {
  bool direction = false;  ///< viscous and Coulomb friction per direction
  bool stribeck = false;   ///< friction at low speed, per direction
  bool ripple = false;     ///< a force, and friction, once and twice per motor turn
  bool stroke = false;     ///< friction along the stroke
};

/// A force model fitted by least squares to F(t) = M a + friction, above 2 mm/s.
class ForceFit {
 public:
  ForceFit(const ForceTerms& terms, const Recording& r, const Segment& segment);

  /// Root mean square of what is left over a segment, N.
  [[nodiscard]] double Residual_N(const Recording& r, const Segment& segment) const;
  /// What is left in one row; NaN below 2 mm/s.
  [[nodiscard]] double ResidualAt_N(const Recording& r, std::size_t row) const;
  /// Amplitude and phase of the force once per turn, whatever the direction.
  [[nodiscard]] std::complex<double> OncePerTurn_N() const;
  /// Coulomb and viscous friction forward and backward.
  struct Levels {
    double Fc_plus_N, Fc_minus_N, Fv_plus_Ns_m, Fv_minus_Ns_m;
  };
  [[nodiscard]] Levels FrictionLevels() const;

 private:
  void Row(const Recording& r, std::size_t k, std::vector<double>& columns) const;
  void Solve(const Recording& r, const Segment& segment);

  ForceTerms terms_;
  double vs_m_s_ = 10e-3;
  std::vector<double> coefficients_;
  std::size_t ripple_column_ = 0;
};

}  // namespace contour::emps
