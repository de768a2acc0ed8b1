#pragma once

#include <array>

#include "estimator/friction_config.h"
#include "estimator/linear_friction.h"

// Parameters of LinearFriction from what is known of an axis. For construction: nothing here belongs into the
// cycle, but nothing allocates either.
namespace contour {

using FrictionMatrix = std::array<FrictionTerms, kFrictionTerms>;

/// Least squares over samples, with a prior of mean zero.
class LinearFrictionFit {
 public:
  void Add(const FrictionTerms& terms, double friction_N, double weight = 1.0) noexcept;
  /// `std`: of each parameter before the samples, in the same units as 1 / sqrt(weight); 0 keeps it at 0.
  [[nodiscard]] FrictionTerms Solve(const FrictionTerms& std) const noexcept;

 private:
  FrictionMatrix normal_{};
  FrictionTerms right_{};
};

/// A law without its viscous part, over small swings and over reversals out of gross sliding.
FrictionTerms FitToLuGre(const LinearFriction& basis, const Friction& friction) noexcept;

}  // namespace contour
