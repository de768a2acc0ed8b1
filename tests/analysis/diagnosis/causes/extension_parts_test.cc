#include "analysis/diagnosis/causes/extension_parts.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

TEST(ExtensionParts, AValueThatIsNoNumberIsTheOtherOne) {
  const Cause c = test::CauseWith("cogging", {{"a", 2.0}, {"b", kNone}, {"c", 1.0 / 0.0}});
  EXPECT_EQ(ValueOf(c, "a", 7.0), 2.0);
  EXPECT_EQ(ValueOf(c, "b", 7.0), 7.0);
  EXPECT_EQ(ValueOf(c, "c", 7.0), 7.0);
  EXPECT_EQ(ValueOf(c, "d"), 0.0);
}

TEST(ExtensionParts, TheTableOverTheStrokeIsThatWithPositions) {
  Cause c;
  EXPECT_EQ(TableOverStroke(c), nullptr);
  c.shapes.push_back({"time_s", "y", {0.0}, {1.0}, {}});
  c.shapes.push_back({"position_mm", "y", {}, {}, {}});
  EXPECT_EQ(TableOverStroke(c), nullptr);
  c.shapes.push_back({"position_mm", "y", {0.0}, {1.0}, {}});
  EXPECT_EQ(TableOverStroke(c), &c.shapes[2]);
}

TEST(ExtensionParts, ATableIsRoundedToWhatAPersonReads) {
  std::vector<double> x, y;
  AddTable({"position_mm", "y", {-10.00000004, 10.0}, {1.0 / 3.0, 2.0}, {}}, Joined::kSum, x, y);
  EXPECT_EQ(x, (std::vector<double>{-10.0, 10.0}));
  EXPECT_EQ(y, (std::vector<double>{0.333333, 2.0}));
}

TEST(ExtensionParts, TwoTablesAreJoinedAtThePointsOfBoth) {
  std::vector<double> x = {0.0, 10.0}, y = {0.0, 1.0};
  AddTable({"position_mm", "y", {5.0, 10.0, 20.0}, {0.1, 0.2, 0.4}, {}}, Joined::kSum, x, y);
  EXPECT_EQ(x, (std::vector<double>{0.0, 5.0, 10.0, 20.0}));
  const std::vector<double> sum = {0.1, 0.6, 1.2, 1.4};  // each goes on as it ends
  for (std::size_t i = 0; i < sum.size(); ++i) EXPECT_NEAR(y[i], sum[i], 1e-9);
}

TEST(ExtensionParts, FactorsMultiply) {
  std::vector<double> x = {0.0}, y = {0.5};
  AddTable({"position_mm", "y", {0.0}, {-0.5}, {}}, Joined::kFactors, x, y);
  EXPECT_NEAR(y[0], -0.25, 1e-9);
}

TEST(ExtensionParts, HalfOfHighestMinusLowest) {
  EXPECT_EQ(HalfRange(std::vector<double>{3.0, -1.0, 2.0}), 2.0);
}

TEST(ExtensionParts, ARippleThatIsThereGetsTheSumOfThePhasors) {
  std::optional<RippleExtension> ripple;
  const auto cause = [](double amplitude, double order, double phase) {
    return test::CauseWith("friction_ripple",
                           {{"amplitude_rel", amplitude}, {"order_per_rev", order}, {"phase_rad", phase}});
  };
  AddRipple(cause(0.3, 2.0, 0.0), ripple);
  AddRipple(cause(0.4, 2.0, 0.5 * std::numbers::pi), ripple);
  EXPECT_NEAR(ripple->amplitude_rel, 0.5, 1e-12);
  EXPECT_NEAR(ripple->phase_rad, std::atan2(0.4, 0.3), 1e-12);
  AddRipple(cause(0.1, 5.0, 0.0), ripple);
  AddRipple(cause(0.1, 5.0, 0.0), ripple);
  ASSERT_EQ(ripple->further.size(), 1u) << "also where the order is not the first";
  EXPECT_NEAR(ripple->further[0].amplitude_rel, 0.2, 1e-12);
}

TEST(ExtensionParts, WithoutARippleNothingIsSimulated) {
  EXPECT_TRUE(RippleInSimulation("ball_ripple", std::nullopt).empty());
  const test::Emulated drawn =
      test::EmulatedWith(DrawnRipple("ball_ripple", {.size = -0.05, .order = 2.4, .phase_rad = 0.3}));
  EXPECT_TRUE(drawn.errors.empty());
  EXPECT_EQ(drawn.axis.effects.ball_ripple->amplitude_rel, -0.05);
  EXPECT_EQ(drawn.axis.effects.ball_ripple->order_per_rev, 2.4);
  EXPECT_EQ(drawn.axis.effects.ball_ripple->phase_rad, 0.3);
}

TEST(ExtensionParts, WhatIsThereAlreadyIsKept) {
  std::optional<int> value = 3;
  EXPECT_EQ(Existing(value), 3);
  std::optional<int> none;
  Existing(none) = 4;
  EXPECT_EQ(none, 4);
}

}  // namespace
}  // namespace contour::diagnosis
