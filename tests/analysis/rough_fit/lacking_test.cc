#include "analysis/rough_fit/lacking.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "analysis/prediction_error/problem.h"
#include "analysis/rough_fit/two_starts.h"
#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

/// Tried on an axis whose model is right but for the effect.
std::vector<Lacking> Tried(const test::HiddenAxis& axis) {
  Problem problem(axis.log, axis.stated, 1);
  Point truth;
  for (const BaseTerm& t : problem.terms) truth.base.push_back(t.start);
  problem.LearnSignals(truth);
  return TryLacking(axis.log, {axis.stated, axis.stated.friction, *problem.signals});
}

test::HiddenAxis Hidden(std::vector<test::HiddenEffect> effects) {
  test::HiddenOptions o;
  o.duration_s = 30.0;
  o.scale = false;
  o.parameter_spread = 0.0;
  o.effects = std::move(effects);
  return MakeHiddenAxis(o);
}

const Lacking& MostSure(const std::vector<Lacking>& all) {
  return *std::max_element(all.begin(), all.end(),
                           [](const Lacking& a, const Lacking& b) { return a.sure < b.sure; });
}

TEST(TryLacking, IsSureOfNothingWhereNothingLacks) {
  const test::HiddenAxis axis = Hidden({});
  const std::vector<Lacking> tried = Tried(axis);
  ASSERT_GT(tried.size(), 4U);
  for (const Lacking& l : tried) {
    EXPECT_LT(l.sure, kDisagree) << TextOf(l, false);
    EXPECT_NEAR(l.inertia.value / axis.stated.motor_inertia, 1.0, 0.02) << TextOf(l, false);
    EXPECT_NEAR(l.viscous.value / axis.stated.friction.s2, 1.0, 0.1) << TextOf(l, false);
  }
}

TEST(TryLacking, FindsACurveAndTheNumbersWithIt) {
  const test::HiddenAxis axis = Hidden({{.kind = "viscous_nonlinear", .size = 0.6, .extra = 2.0}});
  const Lacking most = MostSure(Tried(axis));
  EXPECT_EQ(most.what, Lacking::What::kCurve);
  EXPECT_GT(most.sure, kDisagree);
  EXPECT_NEAR(most.viscous.value / axis.stated.friction.s2, 1.0, 0.1);
  EXPECT_GT(most.viscous_without / axis.stated.friction.s2, 1.3);
}

TEST(TryLacking, RowsOfSmallForceKnowTheInertiaOfADriveAtItsLimit) {
  const test::HiddenAxis axis = Hidden({{.kind = "torque_limit", .size = 0.5}});
  const Lacking most = MostSure(Tried(axis));
  EXPECT_EQ(most.what, Lacking::What::kLessForce);
  EXPECT_GT(most.below, 0.0);
  EXPECT_NEAR(most.inertia.value / axis.stated.motor_inertia, 1.0, 0.05);
  EXPECT_GT(most.inertia_without / axis.stated.motor_inertia, 1.5);
  EXPECT_NE(TextOf(most, false).find(" Nm"), std::string::npos);
}

TEST(WithCentreOfMass, IsBetweenMotorAndLoad) {
  AxisLog log;
  log.position = {0.0, 1.0};
  log.command = {0.0, 0.0};
  log.present = {1, 1};
  StatedAxis axis;
  axis.motor_inertia = 3.0;
  axis.load_inertia = 1.0;
  EXPECT_EQ(WithCentreOfMass(log, axis, {0.0, 2.0}).position, (Signal{0.0, 1.25}));
}

TEST(ShareAtLimit, CountsRowsOfTheLargestCommand) {
  AxisLog log;
  log.command = {1.0, -2.0, 2.0, 3.0, 0.5};
  log.position.assign(5, 0.0);
  log.present = {1, 1, 1, 0, 1};
  EXPECT_DOUBLE_EQ(ShareAtLimit(log), 0.5);
}

}  // namespace
}  // namespace contour::diagnosis
