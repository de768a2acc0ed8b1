#include "estimator/friction_ripple.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace contour {
namespace {

constexpr double kLead_m = 5e-3;

TEST(FrictionRipple, LearnsEachDirectionOfItsOwn) {
  FrictionRipple ripple(kLead_m, 0.1);
  const auto truth = [](double p, bool forward) {
    const double angle = 2.0 * std::numbers::pi * p / kLead_m;
    return forward ? 1.0 + 0.08 * std::sin(angle + 0.7)
                   : 1.0 + 0.05 * std::cos(2.0 * angle) - 0.03 * std::sin(angle);
  };
  const double step = 50e-6;
  for (int k = 0; k < 4000; ++k) {
    const bool forward = (k / 1000) % 2 == 0;
    const double p = forward ? (k % 1000) * step : (1000 - k % 1000) * step;
    const auto basis = ripple.Basis(p);
    ripple.Learn(basis, forward, truth(p, forward) / ripple.Factor(basis, forward) - 1.0,
                 forward ? step : -step);
  }
  for (double p = 0.0; p < kLead_m; p += 1e-4) {
    const auto basis = ripple.Basis(p);
    EXPECT_NEAR(ripple.Factor(basis, true), truth(p, true), 0.004) << p;
    EXPECT_NEAR(ripple.Factor(basis, false), truth(p, false), 0.004) << p;
  }
}

TEST(FrictionRipple, StandingStillTeachesNothing) {
  FrictionRipple ripple(kLead_m, 0.1);
  const auto basis = ripple.Basis(1e-3);
  for (int k = 0; k < 100000; ++k) ripple.Learn(basis, true, 0.3, 0.0);
  EXPECT_EQ(ripple.Factor(basis, true), 1.0);
}

TEST(FrictionRipple, FactorIsBounded) {
  FrictionRipple ripple(kLead_m, 1.0);
  for (int k = 0; k < 10000; ++k) {
    ripple.Learn(ripple.Basis(k * 1e-4), true, 100.0, 1e-4);
    const double factor = ripple.Factor(ripple.Basis(k * 1.3e-4), true);
    ASSERT_GE(factor, 0.6);
    ASSERT_LE(factor, 1.4);
  }
  ripple.Reset();
  EXPECT_EQ(ripple.Factor(ripple.Basis(1e-3), true), 1.0);
}

}  // namespace
}  // namespace contour
