#include "estimator/wind_up_tuning.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

WindUpFit Fit(double stiffness_N_m, double std) {
  WindUpFit::Tuning tuning;
  tuning.stiffness_N_m = stiffness_N_m;
  tuning.stiffness_std = std;
  return WindUpFit(tuning);
}

TEST(ScrewStiffness, OfAComplianceAndItsDeviation) {
  const ScrewStiffness k = ScrewStiffness::Of(1.0 / 40e6, 0.05 / 40e6);
  EXPECT_NEAR(k.N_m, 40e6, 1.0);
  EXPECT_NEAR(k.std_N_m, 2e6, 1.0);
}

TEST(StiffnessBy, NothingLearntYetItIsAsCommissioned) {
  const ScrewStiffness k = StiffnessBy(Fit(40e6, 0.1), 0.0, 0.1);
  EXPECT_NEAR(k.N_m, 40e6, 1.0);
  EXPECT_NEAR(k.std_N_m, 4e6, 1.0);
}

TEST(StiffnessBy, WhereNothingIsLearntTheStatedDeviationStays) {
  const ScrewStiffness k = StiffnessBy(Fit(40e6, 0.0), 0.0, 0.07);
  EXPECT_NEAR(k.std_N_m, 2.8e6, 1.0);
}

// The fit has all friction go through the screw (WindUpTuning), the screw only the table's.
TEST(StiffnessBy, FrictionBeforeTheScrewDoesNotWindItUp) {
  FilterSetup setup;
  setup.friction.motor_share = 0.3;
  setup.mechanics.stiffness_N_m = 40e6;
  setup.config.stiffness_std = 0.1;
  const ScrewStiffness k = StiffnessBy(WindUpFit(WindUpTuning(setup)), 0.3, 0.1);
  EXPECT_NEAR(k.N_m, 40e6, 1.0);
  EXPECT_NEAR(k.std_N_m, 4e6, 1.0);
}

}  // namespace
}  // namespace contour
