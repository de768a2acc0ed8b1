#include "analysis/rough_fit/wrong_units.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

test::HiddenAxis Made() { return test::HiddenAxisFor(30.0); }

std::string Complaint(const test::HiddenAxis& axis) { return WrongUnits(axis.log, axis.stated); }

TEST(WrongUnits, AnAxisIsInOrderThoughItsModelIsOffByTwo) {
  test::HiddenAxis axis = Made();
  EXPECT_EQ(Complaint(axis), "");
  axis.stated.motor_inertia *= 2.0;
  EXPECT_EQ(Complaint(axis), "");
  axis.stated.motor_inertia /= 4.0;
  EXPECT_EQ(Complaint(axis), "");
}

// Before: "nothing was found" of a log in degrees.
TEST(WrongUnits, DegreesAreNoticed) {
  test::HiddenAxis axis = Made();
  for (double& q : axis.log.position) q *= 57.3;
  const std::string degrees = Complaint(axis);
  EXPECT_NE(degrees.find("times less than the model states"), std::string::npos) << degrees;
  EXPECT_NE(degrees.find("--columns"), std::string::npos) << degrees;
}

// Before: a torque constant of 0.3.
TEST(WrongUnits, ASignThatIsTurnedRoundIsNoticed) {
  test::HiddenAxis axis = Made();
  for (double& u : axis.log.command) u = -u;
  const std::string text = Complaint(axis);
  EXPECT_NE(text.find("opposite signs"), std::string::npos) << text;
  EXPECT_NE(text.find("torque_Nm=HEADER*-1"), std::string::npos) << text;
}

// A joint above the horizontal: on one slow sine its weight looks like so many times its inertia.
TEST(WrongUnits, AForceOfThePositionIsNoOtherInertia) {
  test::HiddenAxis axis = Made();
  const double inertia = axis.stated.motor_inertia + axis.stated.load_inertia,
               w = 2.0 * std::numbers::pi * 0.5;
  for (const double spring : {20.0, -20.0}) {
    const double stiffness = spring * inertia * w * w, amplitude = 5.0;
    const double coulomb = 0.05 * std::fabs(stiffness) * amplitude;
    for (std::size_t k = 0; k < axis.log.size(); ++k) {
      const double t = static_cast<double>(k) * axis.log.period_s;
      const double q = amplitude * std::sin(w * t), a = -w * w * q;
      axis.log.position[k] = q;
      axis.log.command[k] = inertia * a - stiffness * q + std::copysign(coulomb, std::cos(w * t));
    }
    EXPECT_EQ(Complaint(axis), "") << spring;
  }
}

TEST(WrongUnits, FastMotionMayShowTheMotorAlone) {
  test::HiddenAxis axis = Made();
  axis.stated.load_inertia = 20.0 * axis.stated.motor_inertia;
  EXPECT_EQ(Complaint(axis), "");
}

TEST(WrongUnits, ACommandOfNothingIsNoticed) {
  test::HiddenAxis axis = Made();
  for (double& u : axis.log.command) u = 0.0;
  EXPECT_NE(Complaint(axis).find("0 in every row"), std::string::npos);
}

}  // namespace
}  // namespace contour::diagnosis
