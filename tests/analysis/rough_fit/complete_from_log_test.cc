#include "analysis/rough_fit/complete_from_log.h"

#include <gtest/gtest.h>

#include "config/config_error.h"
#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

test::HiddenOptions Thirty() {
  test::HiddenOptions o;
  o.duration_s = 30.0;
  o.parameter_spread = 0.0;
  return o;
}

test::HiddenAxis Made() { return test::MakeHiddenAxis(Thirty()); }

TEST(CompleteFromLog, WhatIsOpenComesFromTheLogAndIsUncertain) {
  test::HiddenAxis axis = Made();
  const StatedFriction truth = axis.stated.friction;
  axis.stated.open = {"Fc", "s2"};
  axis.stated.friction.Fc_plus = axis.stated.friction.Fc_minus = 1.0;
  axis.stated.friction.s2 = 0.0;
  EXPECT_EQ(CompleteFromLog(axis.log, axis.stated).size(), 1U);
  EXPECT_NEAR(axis.stated.friction.Fc_plus / truth.Fc_plus, 1.0, 0.3);
  EXPECT_GT(axis.stated.friction.s2, 0.0);
  EXPECT_GE(axis.stated.sigma.at("Fc"), 0.3);
}

/// Before: a curve that nobody had stated was held flat, and told as a cause (11028 nats of Stribeck friction
/// on a sound axis whose model states its inertia alone).
TEST(CompleteFromLog, WithNoFrictionStatedItsCurveIsOpenToo) {
  test::HiddenAxis axis = Made();
  axis.stated.open = {"Fc", "s2", "vs", "s0", "exponent"};
  axis.stated.friction = {.Fc_plus = 1.0, .Fc_minus = 1.0, .Fs_plus = 1.0, .Fs_minus = 1.0, .vs = 1.0};
  test::HiddenAxis levels = axis;
  CompleteFromLog(axis.log, axis.stated);
  EXPECT_GT(axis.stated.friction.Fs_plus, 1.05 * axis.stated.friction.Fc_plus);
  EXPECT_GT(axis.stated.friction.s1, 0.0);
  for (const char* name : {"Fs", "vs", "s0", "s1"}) EXPECT_GE(axis.stated.sigma.at(name), 0.5) << name;
  // Where a curve is stated, it is.
  levels.stated.open = {"Fc", "s2"};
  CompleteFromLog(levels.log, levels.stated);
  EXPECT_EQ(levels.stated.friction.Fs_plus, levels.stated.friction.Fc_plus);
}

/// Before: one frame that reads 30 m made a stroke and a largest speed of its own, and friction of nothing.
TEST(CompleteFromLog, AWrongReadingChangesNothing) {
  test::HiddenAxis axis = Made();
  axis.stated.open = {"Fc", "s2", "vs", "s0"};
  test::HiddenAxis garbled = axis;
  for (const std::size_t k : {3000U, 11111U, 20020U}) garbled.log.position[k] += 3e4;
  CompleteFromLog(axis.log, axis.stated);
  CompleteFromLog(garbled.log, garbled.stated);
  EXPECT_EQ(garbled.log.wrong_readings, 3U);
  EXPECT_NEAR(garbled.stated.friction.Fc_plus / axis.stated.friction.Fc_plus, 1.0, 0.01);
  EXPECT_NEAR(garbled.stated.friction.s2 / axis.stated.friction.s2, 1.0, 0.03);
}

TEST(CompleteFromLog, WhatIsStatedStays) {
  test::HiddenAxis axis = Made();
  const StatedFriction truth = axis.stated.friction;
  EXPECT_TRUE(CompleteFromLog(axis.log, axis.stated).empty());
  EXPECT_EQ(axis.stated.friction, truth);
}

TEST(CompleteFromLog, ACurrentIsATorqueByTheStatedInertia) {
  test::HiddenAxis axis = Made();
  const std::vector<double> torque = axis.log.command;
  for (double& u : axis.log.command) u /= 0.37;
  axis.log.in_ampere = true;
  test::HiddenAxis stated = axis;
  stated.stated.torque_constant = 0.37;
  EXPECT_TRUE(CompleteFromLog(stated.log, stated.stated).empty());
  EXPECT_NEAR(stated.log.command[777], torque[777], 1e-12);
  EXPECT_FALSE(stated.stated.open.contains("ampere"));
  EXPECT_EQ(CompleteFromLog(axis.log, axis.stated).size(), 1U);
  EXPECT_NEAR(axis.stated.torque_constant / 0.37, 1.0, 0.1);
  EXPECT_FALSE(axis.log.in_ampere);
  EXPECT_TRUE(axis.stated.open.contains("ampere"));
}

TEST(CompleteFromLog, WithoutAccelerationACurrentSaysNothing) {
  test::HiddenAxis axis = Made();
  axis.log.in_ampere = true;
  for (std::size_t k = 0; k < axis.log.size(); ++k) {
    axis.log.position[k] = 1e-3 * static_cast<double>(k);
    axis.log.command[k] = 0.1 + 0.01 * static_cast<double>(k % 7);
  }
  EXPECT_THROW(CompleteFromLog(axis.log, axis.stated), ConfigError);
}

TEST(CompleteFromLog, AnAxisWithoutFrictionIsOneWithHardlyAny) {
  test::HiddenAxis axis = Made();
  StatedFriction& f = axis.stated.friction;
  f.Fc_plus = f.Fc_minus = f.Fs_plus = f.Fs_minus = f.s0 = 0.0;
  CompleteFromLog(axis.log, axis.stated);
  EXPECT_GT(f.s0, 0.0);
  EXPECT_GT(f.Fc_plus, 0.0);
}

TEST(CompleteFromLog, ManyTurnsWithoutAStrokeAreEndless) {
  test::HiddenAxis axis = Made();
  axis.stated.lead_m = 0.0;
  axis.stated.open = {"stroke"};
  double ahead = 0.0;
  for (double& q : axis.log.position) q += ahead += 0.1;
  CompleteFromLog(axis.log, axis.stated);
  EXPECT_TRUE(axis.stated.endless);
  axis.stated.endless = false;
  axis.stated.to_and_fro = true;
  CompleteFromLog(axis.log, axis.stated);
  EXPECT_FALSE(axis.stated.endless) << "it is stated";
  axis.stated.to_and_fro = false;
  axis.stated.gear_ratio = 50.0;
  CompleteFromLog(axis.log, axis.stated);
  EXPECT_FALSE(axis.stated.endless);
}

/// Before: an axis without a lead that makes strokes of some turns was taken to turn for ever, and a spring
/// over its stroke was not looked for.
TEST(CompleteFromLog, ManyTurnsToAndFroAreAStroke) {
  test::HiddenAxis axis = Made();
  axis.stated.lead_m = 0.0;
  axis.stated.open = {"stroke"};
  CompleteFromLog(axis.log, axis.stated);
  EXPECT_FALSE(axis.stated.endless);
}

}  // namespace
}  // namespace contour::diagnosis
