#include "analysis/rough_fit/wrong_units.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

test::HiddenAxis Made() {
  test::HiddenOptions o;
  o.duration_s = 30.0;
  return test::MakeHiddenAxis(o);
}

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

TEST(WrongUnits, ACommandOfNothingIsNoticed) {
  test::HiddenAxis axis = Made();
  for (double& u : axis.log.command) u = 0.0;
  EXPECT_NE(Complaint(axis).find("0 in every row"), std::string::npos);
}

}  // namespace
}  // namespace contour::diagnosis
