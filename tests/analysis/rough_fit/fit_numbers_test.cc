#include "analysis/rough_fit/fit_numbers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

test::HiddenOptions Thirty() {
  test::HiddenOptions o;
  o.duration_s = 30.0;
  o.scale = false;
  o.parameter_spread = 0.0;
  return o;
}

test::HiddenAxis Made() { return test::MakeHiddenAxis(Thirty()); }

TEST(FitNumbers, FindsThemFromAModelThatIsFarOff) {
  test::HiddenAxis axis = Made();
  const StatedAxis truth = axis.stated;
  axis.stated.motor_inertia *= 1.5;
  axis.stated.friction.Fc_plus *= 0.6;
  axis.stated.friction.Fc_minus *= 0.6;
  axis.stated.friction.s2 *= 2.0;
  const FittedNumbers found = FitNumbers(axis.log, axis.stated, 1);
  EXPECT_EQ(found.unusable, "");
  EXPECT_NEAR(found.axis.motor_inertia / truth.motor_inertia, 1.0, 0.03);
  EXPECT_NEAR(found.axis.friction.Fc_plus / truth.friction.Fc_plus, 1.0, 0.1);
  EXPECT_GT(found.axis.sigma.at("inertia"), 0.0);
  EXPECT_LT(found.axis.sigma.at("inertia"), 0.05);
}

TEST(FitNumbers, RefusesForcesOfAnotherAxis) {
  test::HiddenAxis axis = Made();
  std::mt19937 random(1);
  std::shuffle(axis.log.command.begin(), axis.log.command.end(), random);
  EXPECT_NE(FitNumbers(axis.log, axis.stated, 1).unusable.find("force"), std::string::npos);
}

TEST(FitNumbers, RefusesForcesOfTheOtherSign) {
  test::HiddenAxis axis = Made();
  for (double& u : axis.log.command) u = -u;
  EXPECT_NE(FitNumbers(axis.log, axis.stated, 1).unusable, "");
}

}  // namespace
}  // namespace contour::diagnosis
