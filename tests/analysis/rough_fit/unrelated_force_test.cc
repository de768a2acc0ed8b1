#include "analysis/rough_fit/unrelated_force.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <string>

#include "tests/analysis/support/hidden_axis.h"

namespace contour::diagnosis {
namespace {

test::HiddenAxis Made() { return test::HiddenAxisFor(30.0); }

std::string Complaint(const test::HiddenAxis& axis) { return UnrelatedForce(axis.log, axis.stated); }

TEST(UnrelatedForce, AnAxisIsInOrder) { EXPECT_EQ(Complaint(Made()), ""); }

TEST(UnrelatedForce, SoIsOneOfWhichEveryFortiethRowIsMissing) {
  test::HiddenAxis axis = Made();
  for (std::size_t k = 20; k < axis.log.size(); k += 40) {
    axis.log.present[k] = 0;
    axis.log.position[k] = std::nan("");
  }
  EXPECT_EQ(Complaint(axis), "");
}

// Three times its friction, of eight periods in a turn: what a motor with much iron does.
TEST(UnrelatedForce, SoIsOneWhoseCoggingIsMostOfItsForce) {
  test::HiddenAxis axis = Made();
  const double amplitude = 3.0 * axis.stated.friction.Fc_plus;
  for (std::size_t k = 0; k < axis.log.size(); ++k)
    axis.log.command[k] += amplitude * std::sin(8.0 * axis.log.position[k]);
  EXPECT_EQ(Complaint(axis), "");
}

// Before: a torque constant of 0.3, with exit status 0.
TEST(UnrelatedForce, NoiseIsNoForceOfTheAxis) {
  test::HiddenAxis axis = Made();
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, axis.stated.friction.Fc_plus);
  for (double& u : axis.log.command) u = normal(random);
  EXPECT_NE(Complaint(axis).find("of one axis"), std::string::npos) << Complaint(axis);
}

TEST(UnrelatedForce, NorIsTheSameForceInEveryRow) {
  test::HiddenAxis axis = Made();
  std::fill(axis.log.command.begin(), axis.log.command.end(), 0.1);
  EXPECT_NE(Complaint(axis).find("the same in every row"), std::string::npos) << Complaint(axis);
}

TEST(UnrelatedForce, APositionThatStandsIsNoMotion) {
  test::HiddenAxis axis = Made();
  std::fill(axis.log.position.begin(), axis.log.position.end(), 0.5);
  EXPECT_NE(Complaint(axis).find("does not move"), std::string::npos) << Complaint(axis);
  std::mt19937 random(2);
  std::uniform_int_distribution<int> count(-1, 1);
  for (double& q : axis.log.position) q += axis.stated.position_step * count(random);
  EXPECT_NE(Complaint(axis), "") << "a count of noise is none either";
}

}  // namespace
}  // namespace contour::diagnosis
