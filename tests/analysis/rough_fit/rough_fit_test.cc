#include "analysis/rough_fit/rough_fit.h"

#include <gtest/gtest.h>

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

TEST(RoughFit, AnAxisThatRestsSaysNothing) {
  test::HiddenAxis axis = test::MakeHiddenAxis(Five());
  for (double& q : axis.log.position) q = 1.0;
  EXPECT_NE(FitRoughly(axis.log, axis.stated).why_not, "");
}

}  // namespace
}  // namespace contour::diagnosis
