#include "analysis/axis_model/stated_parameters.h"

#include <gtest/gtest.h>

#include <cmath>

namespace contour::diagnosis {
namespace {

TEST(SeenAtQ, PowerAndTravelOfTheBristleStay) {
  const StatedFriction table = {42.0, 36.0, 52.0, 47.0, 2e-3, 1.0, 5e6, 3000.0, 3e-3, 500.0};
  const double r = 8e-4;
  const StatedFriction motor = SeenAtQ(table, r);
  // At the same motion force times speed is the same: F v with v = w r.
  EXPECT_NEAR(motor.Fc_plus * 10.0, table.Fc_plus * 10.0 * r, 1e-15);
  EXPECT_NEAR(motor.s2 * 10.0 * 10.0, table.s2 * 10.0 * r * 10.0 * r, 1e-15);
  // A bristle's travel to its level, Fc / s0, is the same travel.
  EXPECT_NEAR(motor.Fc_plus / motor.s0 * r, table.Fc_plus / table.s0, 1e-18);
  EXPECT_NEAR(motor.vs * r, table.vs, 1e-15);
  EXPECT_NEAR(motor.vd * r, table.vd, 1e-15);
  EXPECT_EQ(motor.exponent, table.exponent);
}

TEST(EngineSigmas, TheLargestOfSeveralKeysCounts) {
  const auto sigma = EngineSigmas(
      {{"Fc_plus_N", 0.1}, {"Fc_minus_N", 0.3}, {"vs_rad_s", 0.2}, {"lead_mm", 0.4}, {"nothing", 0.5}});
  EXPECT_EQ(sigma, (std::map<std::string, double>{{"Fc", 0.3}, {"vs", 0.2}}));
  EXPECT_TRUE(IsUncertaintyKey("lead_mm"));
  EXPECT_FALSE(IsUncertaintyKey("nothing"));
}

TEST(SetInertiaSigma, OfARigidAxisIsThatOfTheSum) {
  StatedAxis rigid;
  SetInertiaSigma(rigid, 0.1, 0.2, 3.0, 1.0);
  EXPECT_NEAR(rigid.sigma.at("inertia"), std::hypot(0.3, 0.2) / 4.0, 1e-15);
  EXPECT_FALSE(rigid.sigma.contains("load_inertia"));
  StatedAxis one;
  SetInertiaSigma(one, {}, 0.2, 3.0, 1.0);
  EXPECT_NEAR(one.sigma.at("inertia"), 0.05, 1e-15);
}

TEST(SetInertiaSigma, OfTwoInertiasIsEachItsOwn) {
  StatedAxis two;
  two.two_inertia = true;
  SetInertiaSigma(two, 0.1, 0.2, 3.0, 1.0);
  EXPECT_EQ(two.sigma, (std::map<std::string, double>{{"inertia", 0.1}, {"load_inertia", 0.2}}));
  StatedAxis none;
  SetInertiaSigma(none, {}, {}, 3.0, 1.0);
  EXPECT_TRUE(none.sigma.empty());
}

}  // namespace
}  // namespace contour::diagnosis
