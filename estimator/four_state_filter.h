#pragma once

#include <cstdint>

#include "core/axis.h"
#include "estimator/axis_estimator_input.h"
#include "estimator/drive_lag.h"
#include "estimator/filter_setup.h"
#include "estimator/friction_model.h"
#include "estimator/sqrt_ukf.h"

namespace contour {

/// The paper's filter: states [theta, omega, z, g], here at the table as p = R theta, v = R omega; eqs. 9-10
/// and 11-26 with their errata (docs/estimator.md). One g serves both directions, sigma0 and sigma1 are
/// fixed, and there is no disturbance state. The cures for standstill (noise of g scaled by motion, g kept at
/// rest, bounds) are those of the seven-state filter.
class FourStateFilter {
 public:
  explicit FourStateFilter(const FilterSetup& setup) noexcept;

  void Reset(double position_m) noexcept;
  AxisEstimate Update(const AxisEstimatorInput& in) noexcept;
  [[nodiscard]] double FrictionAhead_N() const noexcept { return friction_ahead_N_; }

 private:
  using X = StateVector<4>;
  using Points = SigmaPoints<4>;

  template <class Row>
  void Propagate(Row& p, Row& v, Row& z, const Row& g, double force_N) const noexcept;
  void Propagate(X& x, double force_N) const noexcept;
  void Follow(double position_m) noexcept;
  [[nodiscard]] double Bristle_N(const X& x) const noexcept;

  FilterSetup setup_;
  DriveLag<1> lag_;
  SqrtUkf<4> core_;
  X noise_{};
  X initial_std_{};
  double level_N_ = 1.0;  // as commissioned, mean of both directions
  double velocity_decay_ = 1.0;
  double velocity_gain_ = 0.0;
  double friction_ahead_N_ = 0.0;
  SuddenGate gate_;
  std::uint32_t gated_in_a_row_ = 0;
  bool following_ = true;
};

}  // namespace contour
