#include "analysis/rough_fit/unlike_directions.h"

#include <gtest/gtest.h>

namespace contour::diagnosis {
namespace {

StatedAxis Stated() {
  StatedAxis axis;
  StatedFriction& f = axis.friction;
  f.Fc_plus = f.Fc_minus = 10.0;
  f.Fs_plus = f.Fs_minus = 12.0;
  return axis;
}

RoughFit Seen(double forth, double back) {
  RoughFit rough;
  rough.coulomb_forth = forth;
  rough.coulomb_back = back;
  rough.coulomb = 0.5 * (forth + back);
  rough.coulomb_sigma = 0.01;
  return rough;
}

TEST(UnlikeDirections, AreNoneWhereTheLogHasThemAsStated) {
  EXPECT_FALSE(FindUnlikeDirections(Seen(20.0, 20.0), Stated()));
  EXPECT_FALSE(FindUnlikeDirections(Seen(10.2, 9.8), Stated()));
  StatedAxis uneven = Stated();
  uneven.friction.Fc_plus = 15.0;
  EXPECT_FALSE(FindUnlikeDirections(Seen(30.0, 20.0), uneven));
  StatedAxis pulled = Stated();
  pulled.offset = -4.0;
  EXPECT_FALSE(FindUnlikeDirections(Seen(14.0, 6.0), pulled));
}

TEST(UnlikeDirections, AForceAndLevelsMakeTheSameOfASlidingAxis) {
  StatedAxis stated = Stated();
  stated.offset = 1.0;
  const auto found = FindUnlikeDirections(Seen(14.0, 6.0), stated);
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ(found->pulled.offset, -4.0);
  EXPECT_DOUBLE_EQ(found->pulled.friction.Fc_plus, 10.0);
  ASSERT_TRUE(found->uneven);
  EXPECT_DOUBLE_EQ(found->uneven->offset, 1.0);
  EXPECT_DOUBLE_EQ(found->uneven->friction.Fc_plus, 15.0);
  EXPECT_DOUBLE_EQ(found->uneven->friction.Fc_minus, 5.0);
  EXPECT_DOUBLE_EQ(found->uneven->friction.Fs_minus, 6.0);
  EXPECT_DOUBLE_EQ(found->by_rel, 0.5);
}

TEST(UnlikeDirections, FrictionPushesNoAxis) {
  const auto found = FindUnlikeDirections(Seen(65.0, -15.0), Stated());
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ(found->pulled.offset, -40.0);
  EXPECT_FALSE(found->uneven);
}

TEST(UnlikeDirections, AreNotKnownOfAnAxisThatGoesOneWay) {
  RoughFit rough = Seen(14.0, 0.0);
  rough.one_direction = true;
  EXPECT_FALSE(FindUnlikeDirections(rough, Stated()));
}

}  // namespace
}  // namespace contour::diagnosis
