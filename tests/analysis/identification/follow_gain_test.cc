#include "analysis/identification/follow_gain.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "analysis/identification/linear_step.h"
#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::FollowGain;
using identify::MakeFollowGain;
using identify::Measured;
using identify::TableAxis;

TEST(FollowGainTest, IsStableAndFollowsMoreCloselyWithABandwidthThatIsLarger) {
  const TableAxis axis = Exactly(PlainAxis());
  double before = 0.0;
  for (const double bandwidth_Hz : {10.0, 60.0, 150.0}) {
    const FollowGain gain = MakeFollowGain(axis, 1e-3, bandwidth_Hz);
    Eigen::Matrix4d corrected = identify::Over(axis, 0.0, 1e-3).a;
    corrected -= gain * corrected.row(0);
    EXPECT_LT(corrected.eigenvalues().cwiseAbs().maxCoeff(), 1.0) << bandwidth_Hz;
    EXPECT_GT(gain(0), before) << bandwidth_Hz;
    before = gain(0);
  }
  EXPECT_LT(before, 1.0);
}

TEST(FollowGainTest, TheStepOfReportsIsTheSmallestChangeOfThem) {
  Measured data;
  data.force_N = {0.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(identify::ReportStep_N(data), 0.0);
  data.reported_N = {1.0, 2.5, 2.5, 2.0};
  EXPECT_EQ(identify::ReportStep_N(data), 0.5);
}

}  // namespace
}  // namespace contour::test
