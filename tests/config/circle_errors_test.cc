#include "config/circle_errors.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

/// F / K of 1 um, counts of 5 nm.
AxisConfig Axis() {
  AxisConfig a;
  a.drive.encoder_counts_per_rev = 1e6;
  a.model.mechanics = {.lead_mm = 5.0,
                       .motor_inertia_kgm2 = 5e-5,
                       .table_mass_kg = 10.0,
                       .screw_stiffness_N_um = 40.0,
                       .screw_damping_Ns_m = 1100.0};
  a.model.friction.Fc_plus_N = 50.0;
  a.model.friction.Fc_minus_N = 30.0;
  return a;
}

TEST(CircleErrors, OfADriveGrowWithItsCountsAndTheScrewsGivingWay) {
  AxisConfig axis = Axis();
  const double fine_m = CircleErrorByDrive_m(axis);
  EXPECT_NEAR(fine_m, 0.25e-6 + 7.0 * 5e-9, 1e-9);
  axis.model.mechanics.screw_stiffness_N_um *= 2.0;
  EXPECT_NEAR(CircleErrorByDrive_m(axis), 0.125e-6 + 7.0 * 5e-9, 1e-9);
  axis.drive.encoder_counts_per_rev = 1e4;
  EXPECT_NEAR(CircleErrorByDrive_m(axis), 0.125e-6 + 7.0 * 500e-9, 1e-9);
}

TEST(CircleErrors, OfTorquesFromHereGrowWithTheLoopsGivingWayAndFriction) {
  AxisConfig axis = Axis();
  EXPECT_NEAR(CircleErrorByTorque_m(axis, 0.25e-6), 0.06 * 40.0 * 0.25e-6, 1e-12);
  EXPECT_NEAR(UsualCircleErrorByTorque_m(axis), 0.5e-6, 1e-12);
  axis.model.friction.Fc_plus_N = 130.0;
  EXPECT_NEAR(CircleErrorByTorque_m(axis, 0.25e-6), 0.06 * 80.0 * 0.25e-6, 1e-12);
  EXPECT_NEAR(UsualCircleErrorByTorque_m(axis), 1e-6, 1e-12);
}

}  // namespace
}  // namespace contour
