#include "analysis/identification/axis_bundle.h"

#include <gtest/gtest.h>

#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::AxisBundle;
using identify::Followed;
using identify::LaneAxis;
using identify::Measured;
using identify::TableAxis;

LaneAxis Lane(const TableAxis& axis) {
  return {Followed{axis, identify::MakeFollowGain(axis, 1e-3, 60.0)}, 1e-3};
}

TEST(AxisBundleTest, EveryLaneIsItsOwnAxis) {
  const TableAxis one = Exactly(PlainAxis());
  TableAxis other = one;
  other.motor_inertia *= 1.1;
  const LaneAxis first = Lane(one), second = Lane(other);
  ASSERT_TRUE(first.RunsWith(second));
  const Measured data = Everything();
  const identify::OwnForce none;
  std::vector<double> a(data.size(), 0.0), b(data.size(), 0.0);
  AxisBundle both({&first, &second});
  both.SetLane(0, &none, {a.data(), nullptr, nullptr});
  both.SetLane(1, &none, {b.data(), nullptr, nullptr});
  both.Run(data);
  EXPECT_NE(a, b);
  EXPECT_EQ(b, identify::PredictionErrors_m(other, data, identify::MakeFollowGain(other, 1e-3, 60.0)));
}

TEST(AxisBundleTest, AxesOfOtherStepsRunApart) {
  const TableAxis one = Exactly(PlainAxis());
  TableAxis later = one, rigid = one;
  later.delay_s += 0.2e-3;
  rigid.two_inertia = false;
  EXPECT_FALSE(Lane(one).RunsWith(Lane(later)));
  EXPECT_FALSE(Lane(one).RunsWith(Lane(rigid)));
}

}  // namespace
}  // namespace contour::test
