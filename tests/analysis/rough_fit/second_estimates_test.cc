#include "analysis/rough_fit/second_estimates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "analysis/rough_fit/fit_numbers.h"
#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

/// Of a stated interval that should hold the truth.
constexpr double kDeviations = 3.0;

test::HiddenOptions Thirty(std::uint64_t seed) {
  test::HiddenOptions o;
  o.seed = seed;
  o.duration_s = 30.0;
  o.scale = false;
  o.parameter_spread = 0.0;
  return o;
}

test::HiddenOptions With(const char* kind, double size, double extra) {
  test::HiddenOptions o = Thirty(1);
  o.effects.push_back({.kind = kind, .size = size, .extra = extra});
  return o;
}

struct Found {
  FittedNumbers numbers;
  StatedAxis truth;
};

/// From a model whose numbers are off.
Found FitFromAfar(test::HiddenAxis axis) {
  Found out{{}, axis.stated};
  StatedFriction& f = axis.stated.friction;
  axis.stated.motor_inertia *= 1.3;
  axis.stated.load_inertia *= 1.3;
  for (double* level : {&f.Fc_plus, &f.Fc_minus, &f.Fs_plus, &f.Fs_minus}) *level *= 0.8;
  f.s2 *= 1.5;
  out.numbers = FitNumbers(axis.log, axis.stated, 1);
  return out;
}

bool Notes(const FittedNumbers& found, const std::string& what) {
  return std::any_of(found.notes.begin(), found.notes.end(),
                     [&](const std::string& n) { return n.find(what) != std::string::npos; });
}

void ExpectInside(const char* name, double fitted, double truth, const FittedNumbers& found) {
  EXPECT_LT(std::fabs(fitted - truth), kDeviations * found.axis.sigma.at(name) * fitted)
      << name << " " << fitted << ", truth " << truth;
}

void ExpectTruthInside(const Found& found) {
  ASSERT_EQ(found.numbers.unusable, "");
  const StatedAxis &axis = found.numbers.axis, &truth = found.truth;
  ExpectInside("inertia", axis.motor_inertia + axis.load_inertia, truth.motor_inertia + truth.load_inertia,
               found.numbers);
  ExpectInside("Fc", axis.friction.Fc_plus, truth.friction.Fc_plus, found.numbers);
  ExpectInside("s2", axis.friction.s2, truth.friction.s2, found.numbers);
}

// Before: refused without a word of the limit, or an inertia that made up for it.
TEST(SecondEstimates, ADriveAtItsLimitIsNamed) {
  for (const double of_rated : {0.3, 0.8}) {
    const FittedNumbers found = FitFromAfar(MakeHiddenAxis(With("torque_limit", of_rated, 0.0))).numbers;
    EXPECT_NE(found.unusable.find("a drive is at its limit"), std::string::npos) << found.unusable;
  }
}

TEST(SecondEstimates, ALimitThatTheLogKnowsOfIsNone) {
  test::HiddenAxis axis = MakeHiddenAxis(With("torque_limit", 0.8, 0.0));
  const double limit = 0.8 * axis.stated.rated;
  for (double& u : axis.log.command) u = std::clamp(u, -limit, limit);
  const Found found = FitFromAfar(axis);
  ExpectTruthInside(found);
  EXPECT_LT(found.numbers.axis.sigma.at("inertia"), 0.02);
}

// Before: the viscous friction 64 % high, stated to 6 %.
TEST(SecondEstimates, DragWithTheSquareOfTheSpeedIsInTheDeviations) {
  const Found found = FitFromAfar(MakeHiddenAxis(With("viscous_nonlinear", 0.6, 2.0)));
  ExpectTruthInside(found);
  EXPECT_TRUE(Notes(found.numbers, "friction is no straight line over the speed"));
  EXPECT_LT(found.numbers.axis.sigma.at("inertia"), 0.05) << "friction is no matter of the inertia";
}

// Before: the inertia 5 % low, stated to 0.6 %, and the viscous friction four times too large, stated to 12
// %.
TEST(SecondEstimates, FrictionThatGrowsWithTheForceIsInTheDeviations) {
  ExpectTruthInside(FitFromAfar(MakeHiddenAxis(With("load_friction", 0.3, 0.0))));
}

TEST(SecondEstimates, AxesThatLackNothingStayAsSure) {
  for (const bool two : {false, true}) {
    test::HiddenOptions o = Thirty(2);
    o.two_inertia = o.friction_on_load = two;
    const Found found = FitFromAfar(MakeHiddenAxis(o));
    ExpectTruthInside(found);
    EXPECT_LT(found.numbers.axis.sigma.at("inertia"), 0.01);
    EXPECT_LT(found.numbers.axis.sigma.at("Fc"), 0.06);
    EXPECT_LT(found.numbers.axis.sigma.at("s2"), 0.15);
    EXPECT_FALSE(Notes(found.numbers, "lacks something"));
  }
}

}  // namespace
}  // namespace contour::diagnosis
