#include "analysis/identification/simd/axis_loops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "analysis/identification/axis_bundle.h"
#include "analysis/prediction_error/simd/lane_loops.h"
#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using namespace identify;

TEST(AxisLoopsTest, TranslationsAgreeToRounding) {
  if (!diagnosis::HasAvx2()) GTEST_SKIP() << "this processor has no AVX2";
  const TableAxis axis = Exactly(PlainAxis());
  const LaneAxis lane({axis, MakeFollowGain(axis, 1e-3, 60.0)}, 1e-3);
  const Measured data = Everything();
  const OwnForce none;
  std::vector<double> errors(data.size(), 0.0);
  AxisBundle bundle({&lane});
  bundle.SetLane(0, &none, {errors.data(), nullptr, nullptr});
  bundle.Run(data);
  const std::vector<double> as_chosen = errors;
  std::fill(errors.begin(), errors.end(), 0.0);
  RunAxisLanesAvx2(bundle.lanes());
  EXPECT_EQ(errors, as_chosen);
  std::fill(errors.begin(), errors.end(), 0.0);
  RunAxisLanesBaseline(bundle.lanes());
  for (std::size_t k = 0; k < errors.size(); ++k) ASSERT_NEAR(errors[k], as_chosen[k], 1e-13) << "row " << k;
}

}  // namespace
}  // namespace contour::test
