#include "analysis/identification/scale_wind_up.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::Measured;
using identify::TableAxis;

double Nothing(double) { return 0.0; }

TEST(WindUpTest, FindsTheScrewWithALinearScale) {
  const TableAxis truth = Exactly(PlainAxis());
  GeneratedAxis axis{PlainAxis(), true};
  const Measured record =
      axis.Drive(StrokesDuration_s(5e-3, {2e-3, 10e-3, 50e-3}), Strokes(5e-3, {2e-3, 10e-3, 50e-3}), Nothing);
  const auto wind_up = identify::FitWindUp({record}, truth);
  ASSERT_TRUE(wind_up.found);
  EXPECT_NEAR(wind_up.stiffness_N_m / truth.stiffness, 1.0, 0.02);
  EXPECT_LT(std::fabs(wind_up.stiffness_N_m / truth.stiffness - 1.0), 4.0 * wind_up.sigma_rel + 0.005);
}

TEST(WindUpTest, WithoutAScaleThereIsNothingToSee) {
  EXPECT_FALSE(identify::FitWindUp({SlidingRecord()}, Exactly(PlainAxis())).found);
}

}  // namespace
}  // namespace contour::test
