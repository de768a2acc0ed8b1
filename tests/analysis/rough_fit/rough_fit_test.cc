#include "analysis/rough_fit/rough_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

test::HiddenOptions Five() {
  test::HiddenOptions o;
  o.duration_s = 5.0;
  return o;
}

TEST(RoughFit, IsGoodEnoughToBeginWith) {
  for (const bool linear : {false, true}) {
    test::HiddenOptions o;
    o.duration_s = 30.0;
    o.linear = linear;
    o.parameter_spread = 0.0;
    const test::HiddenAxis axis = test::MakeHiddenAxis(o);
    const RoughFit fit = FitRoughly(axis.log, axis.stated);
    EXPECT_EQ(fit.why_not, "");
    EXPECT_NEAR(fit.inertia / axis.stated.motor_inertia, 1.0, 0.1);
    EXPECT_NEAR(fit.coulomb / axis.stated.friction.Fc_plus, 1.0, 0.25);
    EXPECT_LT(fit.inertia_sigma_rel, 0.05);
    EXPECT_LT(fit.unexplained, 0.1);
  }
}

// A stroke to and fro at changing speed: mass 2, 10 and falling from 14 at rest, viscous friction 3.
TEST(RoughFit, AFallingFrictionIsTakenOutWhereItIsKnown) {
  AxisLog log;
  log.linear = true;
  log.period_s = 1e-3;
  StatedAxis stated;
  stated.linear = true;
  stated.motor_inertia = 2.0;
  StatedFriction& f = stated.friction;
  f.Fc_plus = f.Fc_minus = 10.0;
  f.Fs_plus = f.Fs_minus = 14.0;
  f.vs = 0.3;
  f.exponent = 1.0;
  for (int k = 0; k < 20000; ++k) {
    const double t = 1e-3 * k, row = 0.5e-3;
    const auto speed = [](double at) { return std::sin(2.0 * at) * (1.0 + 0.5 * std::sin(0.7 * at)); };
    log.position.push_back((k == 0 ? 0.0 : log.position.back()) + 1e-3 * speed(t - row));
    // The command acts in the middle of the row that follows.
    const double v = speed(t + row), a = (speed(t + 2.0 * row) - speed(t)) / 1e-3;
    log.command.push_back(2.0 * a + 3.0 * v + std::copysign(10.0 + 4.0 * std::exp(-std::fabs(v) / 0.3), v));
  }
  log.rows = log.position.size();
  log.present.assign(log.rows, 1);
  const RoughFit plain = FitRoughly(log, stated);
  EXPECT_GT(plain.coulomb, 10.5);
  EXPECT_LT(plain.viscous, 2.8);
  const RoughFit fit = FitRoughly(log, stated, RoughShape::kFriction, &f);
  EXPECT_NEAR(fit.coulomb, 10.0, 0.1);
  EXPECT_NEAR(fit.viscous, 3.0, 0.1);
  EXPECT_NEAR(fit.inertia, 2.0, 0.02);
}

TEST(RoughFit, AnAxisThatRestsSaysNothing) {
  test::HiddenAxis axis = test::MakeHiddenAxis(Five());
  for (double& q : axis.log.position) q = 1.0;
  EXPECT_NE(FitRoughly(axis.log, axis.stated).why_not, "");
}

}  // namespace
}  // namespace contour::diagnosis
