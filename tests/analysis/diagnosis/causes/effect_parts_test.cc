#include "analysis/diagnosis/causes/effect_parts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

SharedSignal Of(Signal s) { return std::make_shared<const Signal>(std::move(s)); }

TEST(EffectParts, SignalsAddUpTimesTheirAmplitudes) {
  const SharedSignal sum = Add(Of({1.0, 1.0}), {Of({1.0, 2.0}), Of({0.0, -1.0})}, {2.0, 3.0});
  EXPECT_EQ(*sum, (Signal{3.0, 2.0}));
  EXPECT_EQ(*Add(nullptr, {Of({1.0, 2.0})}, {0.5}), (Signal{0.5, 1.0}));
}

TEST(EffectParts, ASignalOfTwoPerRowTakesOneOfOnePerRowToItsEnds) {
  // Of two rows: the first elements, then the second ones; a signal between rows ends as the next begins.
  const SharedSignal ends = Of({1.0, 2.0, 3.0, 4.0}), rows = Of({10.0, 20.0});
  const Signal expected = {11.0, 22.0, 23.0, 24.0};
  EXPECT_EQ(*Add(rows, {ends}, {1.0}), expected);
  EXPECT_EQ(*Add(ends, {rows}, {1.0}), expected);
}

TEST(EffectParts, EveryInputIsAnotherPlaceInTheModel) {
  const std::vector<SharedSignal> one = {Of({1.0, 2.0})};
  const auto with = [&](Input input) {
    AxisModel m;
    Enter(m, input, one, {2.0});
    return m;
  };
  const Signal twice = {2.0, 4.0};
  EXPECT_EQ(*with(Input::kMotorForce).motor_force, twice);
  EXPECT_EQ(*with(Input::kLoadForce).load_force, twice);
  EXPECT_EQ(*with(Input::kLevel).level, twice);
  EXPECT_EQ(*with(Input::kViscous).viscous, twice);
  EXPECT_EQ(*with(Input::kReading).reading_error, twice);
  EXPECT_EQ(*with(Input::kScale).scale_error_m, twice);
  EXPECT_FALSE(with(Input::kLevel).motor_force);
  EXPECT_TRUE(IsForce(Input::kMotorForce) && IsForce(Input::kLoadForce));
  EXPECT_FALSE(IsForce(Input::kLevel) || IsForce(Input::kScale));
}

TEST(EffectParts, LevelsMultiplyAndOthersAdd) {
  AxisModel m;
  m.level = Of({0.5, 0.0});
  m.viscous = Of({0.5, 0.0});
  Enter(m, Input::kLevel, {Of({1.0, 1.0})}, {0.2});
  Enter(m, Input::kViscous, {Of({1.0, 1.0})}, {0.2});
  EXPECT_NEAR((*m.level)[0], 1.5 * 1.2 - 1.0, 1e-12);
  EXPECT_NEAR((*m.level)[1], 0.2, 1e-12);
  EXPECT_NEAR((*m.viscous)[0], 0.7, 1e-12);
  // One of them between rows, the other inside them.
  Enter(m, Input::kLevel, {Of({1.0, 1.0, 0.0, 0.0})}, {1.0});
  ASSERT_EQ(m.level->size(), 4u);
  EXPECT_NEAR((*m.level)[0], 2.0 * 1.8 - 1.0, 1e-12);
  EXPECT_NEAR((*m.level)[2], 0.2, 1e-12) << "as the next row begins";
}

TEST(EffectParts, HatsOverTimeAddUpToOne) {
  const std::vector<SharedSignal> hats = HatsOverTime(900, 10);
  ASSERT_EQ(hats.size(), 10u);
  for (std::size_t k = 0; k < 900; ++k) {
    double sum = 0.0;
    for (const SharedSignal& h : hats) sum += (*h)[k];
    ASSERT_NEAR(sum, 1.0, 1e-12) << k;
  }
  EXPECT_NEAR((*hats[3])[300], 1.0, 1e-12);
  EXPECT_NEAR((*hats[3])[350], 0.5, 1e-12);
  EXPECT_EQ((*hats[3])[400], 0.0);
}

TEST(EffectParts, AnEffectWithAnInitialGuessIsTestedByItsFirstNumber) {
  const auto apply = [](const std::vector<double>&, AxisModel&) {};
  const SharedEffect near = Custom({"k", "here", 3}, {.steps = {0.1, 0.2}}, apply);
  EXPECT_EQ(near->tested, 2u);
  EXPECT_EQ(near->kind, "k");
  EXPECT_EQ(near->label, "here");
  EXPECT_EQ(near->grid, 3.0);
  EXPECT_FALSE(near->signals);
  EXPECT_EQ(Custom({"k", "", 1}, {.steps = {0.1, 0.2}, .start = {1.0, 0.0}}, apply)->tested, 1u);
}

TEST(EffectParts, WhatIsAddedToAnEffectLeavesTheOneItWasMadeFrom) {
  const auto apply = [](const std::vector<double>&, AxisModel&) {};
  const SharedEffect e = Custom({"k", "", 1}, {.steps = {0.1}}, apply);
  const SharedEffect other = WithOrder(WithForce(WithShorter(AsSignals(e), e), {1}), 2.5);
  EXPECT_TRUE(other->signals);
  EXPECT_EQ(other->shorter, e);
  EXPECT_EQ(other->force, (std::vector<int>{1}));
  EXPECT_EQ(other->order, 2.5);
  EXPECT_FALSE(e->signals || e->shorter || e->order != 0.0 || !e->force.empty());
}

TEST(EffectParts, AStepIsOfTheSignalsLargestElement) {
  const SharedEffect force =
      LinearEffect({"k", "", 1}, Input::kLoadForce, {Of({1.0, -20.0}), Of({0.0, 0.0})}, 0.01);
  EXPECT_NEAR(force->steps[0], 0.01 / 20.0, 1e-15);
  EXPECT_EQ(force->steps[1], 0.01) << "of a signal that is nothing";
  EXPECT_EQ(force->force, (std::vector<int>{1, 1}));
  EXPECT_TRUE(force->signals);
  const SharedEffect reading = LinearEffect({"k", "", 1}, Input::kReading, {Of({1.0, -20.0})}, 0.01);
  EXPECT_EQ(reading->steps[0], 0.01);
  EXPECT_TRUE(reading->force.empty());
}

TEST(EffectParts, AShapeIsMadeForItsNumberAndScaledByTheAmplitude) {
  const test::KnownAxis axis;
  int made = 0;
  const SharedEffect e = ShapedEffect(axis.problem, {"k", "", 1}, Input::kMotorForce, 0.01, {-1.0, 2.0},
                                      [&](std::size_t k, double x) {
                                        made += k == 0 ? 1 : 0;
                                        return static_cast<double>(k) + x;
                                      });
  EXPECT_NEAR((*test::With(axis, e, {0.5, 2.0}).motor_force)[10], 6.0, 1e-12);
  EXPECT_NEAR((*test::With(axis, e, {2.0, 2.0}).motor_force)[10], 24.0, 1e-12);
  EXPECT_EQ(made, 1) << "one shape for both";
  EXPECT_NEAR((*test::With(axis, e, {2.0, -1.0}).motor_force)[10], 18.0, 1e-12);
  EXPECT_FALSE(test::With(axis, e, {0.0, 1.0}).motor_force);
  EXPECT_EQ(e->low[1], -1.0);
  EXPECT_EQ(e->high[1], 2.0);
  EXPECT_EQ(e->tested, 1u);
  EXPECT_EQ(e->force, (std::vector<int>{1, 0}));
}

}  // namespace
}  // namespace contour::diagnosis
