#include "config/push_advice.h"

#include <gtest/gtest.h>

#include "config/load_machine.h"
#include "config/machine_checks.h"
#include "core/mechanics.h"
#include "tests/config/test_files.h"

namespace contour {
namespace {

MachineConfig Pushed(double pushed_N) {
  MachineConfig c = LoadMachine(ExampleMachine("xy_emulated.yaml"));
  ModelConfig& model = c.axes.at("x").model;
  model.extensions.constant_torque = ConstantTorqueExtension{pushed_N * ToSi(model.mechanics).radius_m_rad};
  return c;
}

std::string Only(const MachineConfig& c) {
  const std::vector<std::string> advice = PushAdvice(c);
  EXPECT_EQ(advice.size(), 1u);
  return advice.empty() ? "" : advice.front();
}

// Rated force is 800 N, a quarter of it 200 N; the ramp of 18 m/s^2 is within the torque limit up to 370 N
// beyond friction.
TEST(PushAdvice, AWeightTakesFromWhatMayPush) {
  EXPECT_TRUE(PushAdvice(Pushed(0.0)).empty());
  EXPECT_TRUE(PushAdvice(Pushed(-199.0)).empty());
  MachineConfig c = Pushed(-210.0);
  EXPECT_TRUE(Check(c).empty()) << "nothing is refused for it";
  EXPECT_TRUE(
      Only(c).starts_with("model.extensions (constant_torque, cable_spring) of axis x states 210 N "
                          "that push the table besides friction. axes.x.limits.external_force_N: "
                          "missing, which is a quarter of rated force, 200.1"))
      << Only(c);
  c.axes.at("x").limits.external_force_N = 205.0;
  EXPECT_NE(Only(c).find("external_force_N: found 205, less than the 210 N"), std::string::npos) << Only(c);
  c.axes.at("x").limits.external_force_N = 211.0;
  EXPECT_TRUE(PushAdvice(c).empty());
}

TEST(PushAdvice, ARampThatTheTorqueLimitCannotFollowAgainstTheWeight) {
  MachineConfig c = Pushed(-450.0);
  AxisConfig& x = c.axes.at("x");
  x.limits.external_force_N = 500.0;
  x.limits.safe_travel_mm = 10.0;
  EXPECT_TRUE(Check(c).empty());
  EXPECT_NE(
      Only(c).find(" axes.x.drive.quick_stop_deceleration_rad_s2: found 22600, but with them the torque "
                   "limit of 1.5 Nm gives "),
      std::string::npos)
      << Only(c);
  x.drive.quick_stop_deceleration_rad_s2 = 20000.0;
  EXPECT_TRUE(PushAdvice(c).empty());
}

TEST(PushAdvice, AWeightThatTakesMoreThanRatedTorqueToHold) {
  MachineConfig c = Pushed(-870.0);
  AxisConfig& x = c.axes.at("x");
  x.limits.external_force_N = 1000.0;
  x.drive.quick_stop_deceleration_rad_s2 = 10000.0;
  EXPECT_NE(Only(c).find(" axes.x.drive.rated_torque_Nm: found 0.637, but to hold them takes 0.65"),
            std::string::npos)
      << Only(c);
  x.model.extensions.constant_torque->torque_Nm *= 0.9;
  EXPECT_TRUE(PushAdvice(c).empty());
}

}  // namespace
}  // namespace contour
