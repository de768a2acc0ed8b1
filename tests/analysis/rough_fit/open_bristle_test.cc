#include "analysis/rough_fit/open_bristle.h"

#include <gtest/gtest.h>

#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

/// A made axis whose bristle nobody stated: it begins with one so many times softer than the axis has.
test::HiddenAxis Made(double duration_s, double softer) {
  test::HiddenOptions o;
  o.duration_s = duration_s;
  o.scale = false;
  o.parameter_spread = 0.0;
  test::HiddenAxis axis = test::MakeHiddenAxis(o);
  axis.stated.friction.s0 /= softer;
  axis.stated.open = {"s0", "s1"};
  axis.stated.sigma["s0"] = axis.stated.sigma["s1"] = 1.0;
  return axis;
}

/// Before: a sound joint that sticks at every reversal had an inertia of 0.038 of 0.05 kg m^2 and a
/// compliance of 323 nats, since the fit of its model began from a bristle of 2.5 mrad.
TEST(OpenBristle, OneThatBeginsTooSoftIsStiffened) {
  const double truth = Made(20.0, 1.0).stated.friction.s0;
  test::HiddenAxis axis = Made(20.0, 64.0);
  const double damping = axis.stated.friction.s1;
  OpenBristle(axis.log, axis.stated);
  EXPECT_GE(axis.stated.friction.s0, 0.124 * truth);
  EXPECT_LE(axis.stated.friction.s0, 1.01 * truth);
  EXPECT_GT(axis.stated.friction.s1, damping);
}

TEST(OpenBristle, OneThatIsRightStays) {
  test::HiddenAxis axis = Made(20.0, 1.0);
  const StatedFriction before = axis.stated.friction;
  OpenBristle(axis.log, axis.stated);
  EXPECT_EQ(axis.stated.friction, before);
}

TEST(OpenBristle, AShortLogSaysNothingOfIt) {
  test::HiddenAxis axis = Made(1.5, 64.0);
  const StatedFriction before = axis.stated.friction;
  OpenBristle(axis.log, axis.stated);
  EXPECT_EQ(axis.stated.friction, before);
}

}  // namespace
}  // namespace contour::diagnosis
