#include "analysis/diagnosis/causes/specimen.h"

#include <gtest/gtest.h>

#include "tests/analysis/support/cause_checks.h"

namespace contour::diagnosis {
namespace {

TEST(Specimen, ASizeIsWithoutItsSign) {
  EXPECT_EQ(SizeAsStated(2.0, -0.3), 0.6);
  EXPECT_EQ(SizeAsStated(2.0, 0.3), 0.6);
}

TEST(Specimen, NumbersAreDrawnEvenlyOrEvenlyInTheLogarithm) {
  EXPECT_EQ(Between(10.0, 30.0, test::Numbers({0.25})), 15.0);
  EXPECT_NEAR(BetweenInLogarithm(10.0, 1000.0, test::Numbers({0.5})), 100.0, 1e-9);
  EXPECT_NEAR(BetweenInLogarithm(10.0, 1000.0, test::Numbers({0.0})), 10.0, 1e-12);
}

TEST(Specimen, AShapeHasOneOrTwoPeriodsOverTheTravel) {
  SpecimenMachine machine = test::MachineToDrawFor();
  machine.emulated_stroke_mm = 260.0;
  machine.travel_mm = 130.0;
  // One over the travel is two over the emulated stroke.
  EXPECT_EQ(WholePeriods(machine, test::Numbers({0.1})), 2.0);
  EXPECT_EQ(WholePeriods(machine, test::Numbers({0.9})), 4.0);
}

}  // namespace
}  // namespace contour::diagnosis
