#include "estimator/friction_along.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimator/linear_friction_fit.h"

namespace contour {
namespace {

constexpr double kStep_m = 1e-6;
/// 40 N, 8 um of presliding.
constexpr Friction kFriction{40.0, 40.0, 40.0, 40.0, 2e-3, 1.0, 5e6, 0.0, 2e-3, 0.0};

/// Friction along a reference that goes up by steps and turns back.
class Walk {
 public:
  explicit Walk(double level_rel) {
    ExtensionsConfig config;
    if (level_rel != 0.0)
      config.position_friction = PositionFrictionExtension{0.0, {-100.0, 100.0}, {level_rel, level_rel}};
    known_ = KnownEffects(config, {5e-3 / 6.283185307179586, 89.0, 10.0, 40e6, 1100.0}, 0.0);
    const LinearFriction basis(ScaleOf(kFriction, 5e-3, -0.1, 0.1));
    parameters_ = FitToLuGre(basis, kFriction);
    along_ = FrictionAlong(basis);
  }
  /// After `count` steps.
  double Go(int count, double direction) {
    for (int i = 0; i < count; ++i) {
      AxisHorizon ahead(2);
      ahead[0] = {at_m_, direction * 1e-3, 0.0, 0.0, 0.0};
      at_m_ += direction * kStep_m;
      ahead[1] = {at_m_, direction * 1e-3, 0.0, 0.0, 0.0};
      along_.Follow(ahead, 2, known_);
    }
    return Sum(parameters_, along_.terms(1));
  }

 private:
  KnownEffects known_;
  FrictionTerms parameters_{};
  FrictionAlong along_;
  double at_m_ = 0.0;
};

TEST(FrictionAlong, AHigherLevelIsReachedLaterByABristleAsStiff) {
  Walk plain(0.0), higher(0.5);
  const double level_N = plain.Go(1000, 1.0), higher_N = higher.Go(1000, 1.0);
  EXPECT_NEAR(higher_N / level_N, 1.5, 0.02);
  // Right behind the reversal a bristle gives way by twice its stiffness, whatever the level.
  const double fell_N = level_N - plain.Go(1, -1.0), higher_fell_N = higher_N - higher.Go(1, -1.0);
  EXPECT_GT(fell_N, 5.0);
  EXPECT_NEAR(higher_fell_N / fell_N, 1.0, 0.1);
}

}  // namespace
}  // namespace contour
