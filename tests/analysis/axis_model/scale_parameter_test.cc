#include "analysis/axis_model/scale_parameter.h"

#include <gtest/gtest.h>

namespace contour::diagnosis {
namespace {

TEST(ScaleParameter, ScalesWhatHasTheNameInBothDirections) {
  StatedAxis axis;
  axis.motor_inertia = 2.0;
  axis.stiffness = 5.0;
  axis.friction.Fc_plus = 3.0;
  axis.friction.Fc_minus = 4.0;
  axis.friction.Fs_plus = 7.0;
  EXPECT_TRUE(ScaleParameter(axis, "inertia", 1.5));
  EXPECT_TRUE(ScaleParameter(axis, "Fc", 2.0));
  EXPECT_EQ(axis.motor_inertia, 3.0);
  EXPECT_EQ(axis.friction.Fc_plus, 6.0);
  EXPECT_EQ(axis.friction.Fc_minus, 8.0);
  EXPECT_EQ(axis.friction.Fs_plus, 7.0);
  EXPECT_EQ(axis.stiffness, 5.0);
}

TEST(ScaleParameter, OfAnotherNameThereIsNone) {
  StatedAxis axis;
  axis.lag_s = 1e-3;
  EXPECT_FALSE(ScaleParameter(axis, "lag", 2.0));
  EXPECT_EQ(axis.lag_s, 1e-3);
}

}  // namespace
}  // namespace contour::diagnosis
