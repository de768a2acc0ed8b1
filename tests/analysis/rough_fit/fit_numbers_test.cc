#include "analysis/rough_fit/fit_numbers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

test::HiddenOptions Thirty() {
  test::HiddenOptions o;
  o.duration_s = 30.0;
  o.scale = false;
  o.parameter_spread = 0.0;
  return o;
}

test::HiddenAxis Made() { return test::MakeHiddenAxis(Thirty()); }

TEST(FitNumbers, FindsThemFromAModelThatIsFarOff) {
  test::HiddenAxis axis = Made();
  const StatedAxis truth = axis.stated;
  axis.stated.motor_inertia *= 1.5;
  axis.stated.friction.Fc_plus *= 0.6;
  axis.stated.friction.Fc_minus *= 0.6;
  axis.stated.friction.s2 *= 2.0;
  const FittedNumbers found = FitNumbers(axis.log, axis.stated, 1);
  EXPECT_EQ(found.unusable, "");
  EXPECT_NEAR(found.axis.motor_inertia / truth.motor_inertia, 1.0, 0.03);
  EXPECT_NEAR(found.axis.friction.Fc_plus / truth.friction.Fc_plus, 1.0, 0.1);
  EXPECT_GT(found.axis.sigma.at("inertia"), 0.0);
  EXPECT_LT(found.axis.sigma.at("inertia"), 0.05);
}

// Before: the constant made the stated inertia that of the log, and the file had another inertia.
TEST(FitNumbers, ALogInAmpereKeepsTheStatedInertia) {
  test::HiddenAxis axis = Made();
  constexpr double kConstant = 0.5;
  for (double& u : axis.log.command) u /= kConstant;
  axis.log.in_ampere = true;
  const double inertia = axis.stated.motor_inertia + axis.stated.load_inertia;
  const FittedNumbers found = FitNumbers(axis.log, axis.stated, 1);
  EXPECT_EQ(found.unusable, "");
  EXPECT_NEAR((found.axis.motor_inertia + found.axis.load_inertia) / inertia, 1.0, 1e-9);
  EXPECT_NEAR(found.axis.torque_constant / kConstant, 1.0, 0.03);
  EXPECT_NEAR(found.axis.friction.Fc_plus / axis.stated.friction.Fc_plus, 1.0, 0.1);
}

bool Says(const FittedNumbers& found, const std::string& what) {
  return std::any_of(found.notes.begin(), found.notes.end(),
                     [&](const std::string& n) { return n.find(what) != std::string::npos; });
}

// Before: levels in the stated ratio, right for neither direction, and an inertia and a viscous friction that
// made up for it, stated to a few hundredths.
TEST(FitNumbers, AForceThatTheModelDoesNotStateIsInTheFile) {
  test::HiddenAxis axis = Made();
  EXPECT_FALSE(Says(FitNumbers(axis.log, axis.stated, 1), "Forth and back differ"));
  const double weight = 1.5 * axis.stated.friction.Fc_plus;
  for (double& u : axis.log.command) u += weight;
  const FittedNumbers found = FitNumbers(axis.log, axis.stated, 1);
  EXPECT_EQ(found.unusable, "");
  EXPECT_TRUE(Says(found, "The file has constant_torque_Nm for it"));
  EXPECT_NEAR(found.axis.offset / weight, -1.0, 0.03);
  EXPECT_NEAR(found.axis.motor_inertia / axis.stated.motor_inertia, 1.0, 0.03);
  EXPECT_NEAR(found.axis.friction.Fc_plus / axis.stated.friction.Fc_plus, 1.0, 0.1);
  EXPECT_NEAR(found.axis.friction.s2 / axis.stated.friction.s2, 1.0, 0.1);
  EXPECT_LT(found.axis.sigma.at("Fc"), 0.1);
}

// Before: each of two models was judged by the noise that was learnt of it, and one of them was much
// likelier: levels 10 % off, stated to 3 %.
TEST(FitNumbers, AForceAndUnevenLevelsAtOnceAreNoneOfTheTwo) {
  test::HiddenOptions o = Thirty();
  o.effects = {{.kind = "asymmetric_coulomb", .size = 0.2}, {.kind = "constant_torque", .size = -0.1}};
  const test::HiddenAxis axis = MakeHiddenAxis(o);
  const FittedNumbers found = FitNumbers(axis.log, axis.stated, 1);
  EXPECT_EQ(found.unusable, "");
  EXPECT_TRUE(Says(found, "do not tell it from"));
  const StatedFriction &fitted = found.axis.friction, &stated = axis.stated.friction;
  EXPECT_NEAR(fitted.Fc_plus, 1.1 * stated.Fc_plus, found.axis.sigma.at("Fc") * fitted.Fc_plus);
  EXPECT_NEAR(fitted.Fc_minus, 0.9 * stated.Fc_minus, found.axis.sigma.at("Fc") * fitted.Fc_minus);
}

TEST(FitNumbers, AStatedForceThatIsAnotherMovesThere) {
  test::HiddenAxis axis = Made();
  const double weight = 1.5 * axis.stated.friction.Fc_plus;
  for (double& u : axis.log.command) u += weight;
  axis.stated.offset = 0.2 * weight;
  const FittedNumbers found = FitNumbers(axis.log, axis.stated, 1);
  EXPECT_EQ(found.unusable, "");
  EXPECT_NEAR(found.axis.offset / weight, -1.0, 0.03);
}

// An axis that hardly accelerates says nothing of its inertia, and the message is not that the model lacks
// something.
TEST(FitNumbers, AsksForQuickReversalsWhereNothingAccelerates) {
  test::HiddenAxis axis = Made();
  StatedAxis& stated = axis.stated;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.05 * stated.friction.Fc_plus);
  constexpr double kTurn_s = 5.0;
  for (std::size_t k = 0; k < axis.log.size(); ++k) {
    const double t = axis.log.period_s * static_cast<double>(k), phase = 2.0 * M_PI * t / kTurn_s;
    const double speed = 2.0 * std::cos(phase);
    axis.log.position[k] = 2.0 * kTurn_s / (2.0 * M_PI) * std::sin(phase);
    axis.log.command[k] =
        stated.friction.Fc_plus * std::tanh(20.0 * speed) + stated.friction.s2 * speed + noise(random);
  }
  const std::string said = FitNumbers(axis.log, stated, 1).unusable;
  EXPECT_NE(said.find("says nothing of the inertia"), std::string::npos) << said;
  EXPECT_NE(said.find("record quick reversals"), std::string::npos) << said;
}

TEST(FitNumbers, RefusesForcesOfAnotherAxis) {
  test::HiddenAxis axis = Made();
  std::mt19937 random(1);
  std::shuffle(axis.log.command.begin(), axis.log.command.end(), random);
  EXPECT_NE(FitNumbers(axis.log, axis.stated, 1).unusable.find("force"), std::string::npos);
}

TEST(FitNumbers, RefusesForcesOfTheOtherSign) {
  test::HiddenAxis axis = Made();
  for (double& u : axis.log.command) u = -u;
  EXPECT_NE(FitNumbers(axis.log, axis.stated, 1).unusable, "");
}

/// 12 s at changing speed, never back: inertia 3e-4, Coulomb 0.08, viscous 3e-4, and noise of 5 mN m.
AxisLog OneWay() {
  AxisLog log;
  log.period_s = 1e-3;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 5e-3);
  double q = 0.0, w = 60.0;
  for (int k = 0; k < 12000; ++k) {
    const double t = 1e-3 * k;
    const double aim = 60.0 + 40.0 * std::sin(1.3 * t) + 10.0 * std::sin(9.0 * t);
    const double u = 0.08 + 3e-4 * w + 3e-4 * 30.0 * (aim - w);
    log.position.push_back(1e-4 * std::round(q / 1e-4));
    log.command.push_back(u);
    const double a = (u + noise(random) - 0.08 - 3e-4 * w) / 3e-4;
    q += 1e-3 * w + 0.5e-6 * a;
    w += 1e-3 * a;
  }
  log.rows = log.position.size();
  log.present.assign(log.rows, 1);
  return log;
}

TEST(FitNumbers, AnAxisThatOnlyGoesOneWaySaysNothingOfItsLevelAlone) {
  StatedAxis stated;
  stated.motor_inertia = 2.8e-4;
  stated.friction.Fc_plus = stated.friction.Fc_minus = 0.07;
  stated.friction.Fs_plus = stated.friction.Fs_minus = 0.07;
  stated.friction.vs = 1.0;
  stated.friction.s0 = 28.0;
  stated.friction.s2 = 2e-4;
  stated.position_step = 1e-4;
  stated.endless = true;
  const FittedNumbers found = FitNumbers(OneWay(), stated, 1);
  EXPECT_EQ(found.unusable, "");
  EXPECT_NEAR(found.axis.motor_inertia, 3e-4, 0.1e-4);
  EXPECT_GE(found.axis.sigma.at("Fc"), 1.0);
  ASSERT_FALSE(found.notes.empty());
  EXPECT_NE(found.notes.back().find("one direction"), std::string::npos);
}

}  // namespace
}  // namespace contour::diagnosis
