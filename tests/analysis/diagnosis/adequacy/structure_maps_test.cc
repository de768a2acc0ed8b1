#include "analysis/diagnosis/adequacy/structure_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/analysis/support/known_axis.h"

namespace contour::diagnosis {
namespace {

class StructureMapsTest : public testing::Test {
 protected:
  StructureMapsTest() { axis_.problem.counted.assign(test::KnownAxis::kRows, 1); }

  const BinnedRows& Over(const std::string& what) const {
    return *std::find_if(maps_.begin(), maps_.end(),
                         [&](const BinnedRows& m) { return m.over.starts_with(what); });
  }
  bool Has(const std::string& what) const {
    return std::any_of(maps_.begin(), maps_.end(),
                       [&](const BinnedRows& m) { return m.over.starts_with(what); });
  }
  void Make() { maps_ = StructureMaps(axis_.problem, Slides(axis_.problem)); }

  test::KnownAxis axis_;
  std::vector<BinnedRows> maps_;
};

TEST_F(StructureMapsTest, RowsSlideWhereTheyCountAndFrictionFollowsTheMotion) {
  axis_.problem.signals->sign[100] = 0.3;
  axis_.problem.counted[200] = 0;
  const std::vector<bool> slides = Slides(axis_.problem);
  EXPECT_FALSE(slides[100]);
  EXPECT_FALSE(slides[200]);
  EXPECT_TRUE(slides[300]);
  EXPECT_TRUE(slides[1000]) << "the other direction, too";
  Make();
  for (const BinnedRows& m : maps_) EXPECT_LT(m.bin[100], 0) << m.over;
}

TEST_F(StructureMapsTest, EveryBinIsOneOfThoseThatAreCounted) {
  Make();
  for (const BinnedRows& m : maps_) {
    ASSERT_EQ(m.bin.size(), test::KnownAxis::kRows);
    for (const int b : m.bin) {
      ASSERT_LT(b, m.count) << m.over;
      ASSERT_GE(b, 0) << m.over;
    }
    EXPECT_FALSE(m.place(0).empty());
  }
}

// Before: millimetres of an axis that turns.
TEST_F(StructureMapsTest, WhatTurnsIsToldInRadians) {
  Make();
  EXPECT_NE(Over("the position").place(0).find(" mm"), std::string::npos);
  // At the carriage, then taken for an axis without a lead.
  test::KnownAxis turning({.linear = true});
  turning.log.linear = false;
  turning.problem.counted.assign(test::KnownAxis::kRows, 1);
  maps_ = StructureMaps(turning.problem, Slides(turning.problem));
  EXPECT_NE(Over("the position").place(0).find(" rad"), std::string::npos);
  EXPECT_NE(Over("the speed").place(0).find(" rad/s"), std::string::npos);
  EXPECT_NE(Over("the travel").place(0).find(" rad after"), std::string::npos);
}

TEST_F(StructureMapsTest, APlaceIsTheSameWheneverItIsPassedInTheSameDirection) {
  Make();
  const BinnedRows& position = Over("the position");
  EXPECT_EQ(position.quantity, Quantity::kPosition);
  // x = 50 mm sin(pi t): up until 0.5 s, down until 1.5 s, up again; 0.1 s and 0.9 s are one place.
  EXPECT_NE(position.bin[100], position.bin[900]);
  EXPECT_EQ(position.bin[100] % (position.count / 2), position.bin[900] % (position.count / 2));
  EXPECT_NE(position.place(position.bin[100]).find("moving up"), std::string::npos);
  EXPECT_NE(position.place(position.bin[900]).find("moving down"), std::string::npos);
  // The bin's middle in mm, the stroke's middle at 20 mm.
  const double at_mm = std::stod(position.place(position.bin[100]));
  EXPECT_NEAR(at_mm, 20.0 + 50.0 * std::sin(0.1 * std::numbers::pi), 100.0 / (position.count / 2));
}

TEST_F(StructureMapsTest, SpeedsAreInMillimetresPerSecond) {
  Make();
  const BinnedRows& speed = Over("the speed");
  const int bins = speed.count / 2;
  // At 1/3 s half of 157 mm/s.
  EXPECT_NEAR(std::stod(speed.place(speed.bin[333])), 78.5, 157.0 / bins * 1.5);
  EXPECT_EQ(speed.bin[0], speed.count - 1) << "the highest one";
}

TEST_F(StructureMapsTest, AnAngleIsOfOneTurnAndMakesASeries) {
  Make();
  const BinnedRows& angle = Over("the angle");
  EXPECT_TRUE(angle.series);
  EXPECT_FALSE(Over("the position").series);
  // One turn is 10 mm: rows at 5 mm and at 15 mm of the travel, in the same direction.
  const auto row = [](double travel_mm) {
    return static_cast<std::size_t>(std::lround(1000.0 * std::asin(travel_mm / 50.0) / std::numbers::pi));
  };
  EXPECT_LE(std::abs(angle.bin[row(2.9)] - angle.bin[row(12.9)]), 1);
  EXPECT_GT(std::abs(angle.bin[row(2.9)] - angle.bin[row(7.9)]), angle.count / 8);
}

TEST_F(StructureMapsTest, WithoutAThermometerThereIsNoTemperature) {
  Make();
  EXPECT_TRUE(Has("the temperature"));
  EXPECT_NEAR(std::stod(Over("the temperature").place(0)), 24.0, 0.5);
  axis_.problem.signals->temperature_K.clear();
  Make();
  EXPECT_FALSE(Has("the temperature"));
}

TEST_F(StructureMapsTest, TimeIsATorqueAndAFrictionEachWithItsOwnAllowance) {
  Make();
  const BinnedRows &torque = Over("time, as a torque"), &friction = Over("time, as friction");
  EXPECT_TRUE(torque.size.empty());
  EXPECT_EQ(friction.size, axis_.problem.signals->sign);
  EXPECT_EQ(torque.structure_class, kUnexplainedTorque);
  EXPECT_EQ(friction.structure_class, kUnexplainedFriction);
  EXPECT_EQ(Over("the position").structure_class, kUnexplainedAll);
  EXPECT_TRUE(std::is_sorted(torque.bin.begin(), torque.bin.end()));
  EXPECT_EQ(torque.bin.back(), torque.count - 1);
}

TEST_F(StructureMapsTest, TheFrictionCurveIsOfTheSpeedWithTheSignOfTheMotion) {
  const BinnedRows curve = FrictionCurve(axis_.problem, Slides(axis_.problem));
  EXPECT_EQ(curve.size, axis_.problem.signals->sign);
  EXPECT_EQ(curve.bin[333], curve.bin[667]) << "half the speed, up and down";
  EXPECT_GT(curve.bin[100], curve.bin[450]);
}

}  // namespace
}  // namespace contour::diagnosis
