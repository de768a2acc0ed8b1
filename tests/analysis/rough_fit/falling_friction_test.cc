#include "analysis/rough_fit/falling_friction.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

/// A made axis, with a curve of friction and without, as it is when nobody has stated that.
struct Made {
  explicit Made(double duration_s, std::vector<test::HiddenEffect> effects = {}) {
    test::HiddenOptions o;
    o.duration_s = duration_s;
    o.scale = false;
    o.parameter_spread = 0.0;
    o.effects = std::move(effects);
    axis = test::MakeHiddenAxis(o);
    StatedFriction& f = axis.stated.friction;
    exponent = f.exponent;
    ratio = f.Fs_plus / f.Fc_plus;
    f.Fs_plus = f.Fc_plus;
    f.Fs_minus = f.Fc_minus;
    f.exponent = 1.0;
    for (const char* name : {"Fc", "s0", "s1", "s2"}) axis.stated.sigma[name] = 0.5;
    axis.stated.open = {"Fc", "s2", "vs", "s0", "exponent"};
  }
  test::HiddenAxis axis;
  double exponent = 0.0, ratio = 0.0;
};

TEST(OpenFallingFriction, TakesTheCurveOfTheAxis) {
  Made made(30.0);
  ASSERT_GT(made.ratio, 1.1);
  OpenFallingFriction(made.axis.log, made.axis.stated);
  const StatedFriction& f = made.axis.stated.friction;
  EXPECT_GT(f.Fs_plus, 1.05 * f.Fc_plus);
  EXPECT_EQ(f.exponent, made.exponent);
  EXPECT_GE(made.axis.stated.sigma.at("Fs"), 0.5);
  EXPECT_GE(made.axis.stated.sigma.at("vs"), 0.5);
}

TEST(OpenFallingFriction, AShortLogSaysNothingOfIt) {
  Made made(1.5);
  const StatedAxis before = made.axis.stated;
  OpenFallingFriction(made.axis.log, made.axis.stated);
  EXPECT_EQ(made.axis.stated.friction, before.friction);
  EXPECT_EQ(made.axis.stated.sigma, before.sigma);
}

}  // namespace
}  // namespace contour::diagnosis
