#include "analysis/rough_fit/quick_fit.h"

#include <gtest/gtest.h>

#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

test::HiddenAxis Made() {
  test::HiddenOptions o;
  o.duration_s = 20.0;
  o.scale = false;
  o.parameter_spread = 0.0;
  return test::MakeHiddenAxis(o);
}

TEST(FitQuickly, FindsALevelThatIsStatedWrong) {
  test::HiddenAxis axis = Made();
  const StatedFriction truth = axis.stated.friction;
  for (double* level : {&axis.stated.friction.Fc_plus, &axis.stated.friction.Fc_minus,
                        &axis.stated.friction.Fs_plus, &axis.stated.friction.Fs_minus})
    *level *= 1.2;
  axis.stated.sigma["Fc"] = axis.stated.sigma["Fs"] = 0.5;
  EXPECT_NEAR(FitQuickly(axis.log, axis.stated).friction.Fc_plus / truth.Fc_plus, 1.0, 0.03);
}

TEST(FitQuickly, AWrongNumberThatCannotMoveIsLessLikely) {
  test::HiddenAxis axis = Made();
  const double right = FitQuickly(axis.log, axis.stated).unlikeliness;
  axis.stated.motor_inertia *= 1.3;
  axis.stated.sigma["inertia"] = 1e-4;
  EXPECT_GT(FitQuickly(axis.log, axis.stated).unlikeliness, right + 100.0);
}

}  // namespace
}  // namespace contour::diagnosis
