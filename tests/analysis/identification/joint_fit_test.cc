#include "analysis/identification/joint_fit.h"

#include <gtest/gtest.h>

#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::TableAxis;

TEST(JointFitTest, FindsEveryParameterFromAModelThatIsHalfWrong) {
  const TableAxis truth = Exactly(PlainAxis());
  TableAxis start = truth;
  start.motor_inertia *= 1.2;
  start.load_inertia *= 1.3;
  start.stiffness *= 0.85;
  start.friction.Fc_plus *= 0.7;
  start.friction.Fc_minus *= 1.4;
  start.friction.Fs_plus *= 0.9;
  start.friction.Fs_minus *= 1.4;
  start.friction.vs *= 1.5;
  start.friction.s0 *= 0.6;
  start.friction.s1 *= 0.5;
  start.friction.s2 *= 1.3;
  start.lag_s = 0.3e-3;
  start.variation.low_m = 0.0;
  start.variation.high_m = 25e-3;
  const auto fit = identify::FitJointly(start, {Everything()}, {});
  const TableAxis& a = fit.axis;
  EXPECT_NEAR(a.mass_kg() / truth.mass_kg(), 1.0, 0.005);
  EXPECT_NEAR(a.load_inertia / truth.load_inertia, 1.0, 0.03);
  EXPECT_NEAR(a.stiffness / truth.stiffness, 1.0, 0.03);
  EXPECT_NEAR(a.friction.Fc_plus / truth.friction.Fc_plus, 1.0, 0.01);
  EXPECT_NEAR(a.friction.Fc_minus / truth.friction.Fc_minus, 1.0, 0.01);
  EXPECT_NEAR(a.friction.Fs_plus / truth.friction.Fs_plus, 1.0, 0.01);
  EXPECT_NEAR(a.friction.Fs_minus / truth.friction.Fs_minus, 1.0, 0.01);
  EXPECT_NEAR(a.friction.vs / truth.friction.vs, 1.0, 0.05);
  EXPECT_NEAR(a.friction.s0 / truth.friction.s0, 1.0, 0.02);
  EXPECT_NEAR(a.friction.s1 / truth.friction.s1, 1.0, 0.1);
  EXPECT_NEAR(a.friction.s2 / truth.friction.s2, 1.0, 0.02);
  EXPECT_NEAR(a.delay_s + a.lag_s, truth.delay_s + truth.lag_s, 10e-6);
  for (const auto& p : fit.parameters) EXPECT_GT(p.sigma, 0.0) << p.key;
}

// Two masses without a part that swings, say, may have taken the lag for a delay.
TEST(JointFitTest, ALagComesBackFromZero) {
  const TableAxis truth = Exactly(PlainAxis());
  for (const double lag_s : {0.0, 2e-6, 20e-6}) {
    TableAxis start = truth;
    start.lag_s = lag_s;
    start.delay_s += truth.lag_s - lag_s;
    start.variation.high_m = 25e-3;
    identify::FitOptions options;
    options.only = {"lag_s", "delay_s"};
    options.spread = false;
    const auto fit = identify::FitJointly(start, {Everything()}, options);
    EXPECT_NEAR(fit.axis.lag_s, truth.lag_s, 20e-6) << lag_s;
    EXPECT_NEAR(fit.axis.delay_s, truth.delay_s, 20e-6) << lag_s;
  }
}

// The table is seen with the stiffness, as an antiresonance, and so stated no better.
TEST(JointFitTest, TheTableIsStatedNoBetterThanTheScrewsStiffness) {
  for (const char* key : {"table_mass_kg", "screw_stiffness_N_um"}) {
    TableAxis start = Exactly(PlainAxis());
    start.variation.high_m = 25e-3;
    identify::FitOptions options;
    options.only = {key};
    options.rounds = 1;
    const auto fit = identify::FitJointly(start, {Everything()}, options);
    EXPECT_GE(identify::Sigma(fit.parameters, key), 2e-3) << key;
  }
}

TEST(JointFitTest, WhatIsHeldStaysAndOnlyWhatIsAskedForMoves) {
  TableAxis start = Exactly(PlainAxis());
  start.friction.Fc_plus *= 1.1;
  start.variation.high_m = 25e-3;
  identify::FitOptions options;
  options.only = {"Fc_plus_N", "sigma2_Ns_m"};
  options.hold = {"sigma2_Ns_m"};
  options.rounds = 1;
  options.spread = false;
  const auto fit = identify::FitJointly(start, {Everything()}, options);
  ASSERT_EQ(fit.parameters.size(), 1U);
  EXPECT_EQ(fit.parameters[0].key, "Fc_plus_N");
  EXPECT_EQ(identify::Sigma(fit.parameters, "sigma2_Ns_m"), 0.0);
  EXPECT_EQ(fit.axis.friction.s2, start.friction.s2);
  EXPECT_NEAR(fit.axis.friction.Fc_plus / 42.0, 1.0, 0.02);
  EXPECT_LT(fit.error_rms_m, fit.error_rms_before_m);
}

}  // namespace
}  // namespace contour::test
