#include "config/circle_errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "config/friction_choice.h"

namespace contour {
namespace {

constexpr double kPeriod_s = 1e-3;

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
  a.model.friction.sigma0_N_m = 5e6;
  a.limits.acceleration_mm_s2 = 5000.0;
  return a;
}

TEST(CircleErrors, OfADriveGrowWithItsCountsAndTheScrewsGivingWay) {
  AxisConfig axis = Axis();
  const double fine_m = CircleErrorByDrive_m(axis, ReportsAreNoise(axis, kPeriod_s));
  EXPECT_NEAR(fine_m, 0.25e-6 + 7.0 * 5e-9, 0.02 * fine_m);
  axis.model.mechanics.screw_stiffness_N_um *= 2.0;
  EXPECT_NEAR(CircleErrorByDrive_m(axis, ReportsAreNoise(axis, kPeriod_s)), 0.125e-6 + 7.0 * 5e-9, 2e-9);
  // 40 N on 89 kg: 0.22 um in a millisecond. Beyond, what is made of its reports is averaged.
  axis.drive.encoder_counts_per_rev = 25000;
  EXPECT_NEAR(CircleErrorByDrive_m(axis, ReportsAreNoise(axis, kPeriod_s)), 0.125e-6 + 7.0 * 200e-9, 2e-9);
  EXPECT_NEAR(CircleErrorByDrive_m(axis, ReportsAreNoise(axis, 0.5 * kPeriod_s)), 0.125e-6 + 3.0 * 200e-9,
              2e-9);
  axis.drive.encoder_counts_per_rev = 1e4;
  EXPECT_NEAR(CircleErrorByDrive_m(axis, ReportsAreNoise(axis, kPeriod_s)), 0.125e-6 + 3.0 * 500e-9, 2e-9);
}

/// The farthest that a table swings on its screw, over how far it gives way in the end, when friction turns
/// round as at a reversal of the 10 mm circle.
double Farthest(const AxisConfig& axis) {
  constexpr double kStep_s = 1e-6, kAway_m_s2 = 0.25;
  const double mass_kg = axis.model.mechanics.table_mass_kg;
  const double stiffness_N_m = 1e6 * axis.model.mechanics.screw_stiffness_N_um;
  const double force_N = 0.5 * (axis.model.friction.Fc_plus_N + axis.model.friction.Fc_minus_N);
  const double bending_m = force_N / axis.model.friction.sigma0_N_m;
  double position_m = 0.0, velocity_m_s = 0.0, farthest_m = 0.0;
  for (int k = 0; k < 300000; ++k) {
    const double t = k * kStep_s;
    const double turned_N = force_N * (1.0 - std::exp(-0.5 * kAway_m_s2 * t * t / bending_m));
    velocity_m_s +=
        kStep_s / mass_kg *
        (turned_N - stiffness_N_m * position_m - axis.model.mechanics.screw_damping_Ns_m * velocity_m_s);
    position_m += kStep_s * velocity_m_s;
    farthest_m = std::max(farthest_m, position_m);
  }
  return farthest_m / (force_N / stiffness_N_m);
}

// Tables of 20 to 100 Hz on their screws, little and much damped.
TEST(CircleErrors, OfADriveHaveTheTablesSwingOnItsScrew) {
  for (const double table_kg : {100.0, 500.0, 2500.0})
    for (const double damping_Ns_m : {1100.0, 30000.0}) {
      AxisConfig axis = Axis();
      axis.model.mechanics.table_mass_kg = table_kg;
      axis.model.mechanics.screw_damping_Ns_m = damping_Ns_m;
      const double gives_way =
          (CircleErrorByDrive_m(axis, ReportsAreNoise(axis, kPeriod_s)) - 7.0 * 5e-9) / 0.25e-6;
      EXPECT_NEAR(gives_way, Farthest(axis), 0.06 * Farthest(axis)) << table_kg << ' ' << damping_Ns_m;
    }
  AxisConfig heavy = Axis();
  heavy.model.mechanics.table_mass_kg = 2500.0;
  EXPECT_GT(CircleErrorByDrive_m(heavy, ReportsAreNoise(heavy, kPeriod_s)),
            1.7 * CircleErrorByDrive_m(Axis(), ReportsAreNoise(Axis(), kPeriod_s)));
}

// With 5 nm a count a quarter is left; with 0.2 um behind a stiff screw what is made from a drive's reports
// costs more than it gains, and with 2 um it is averaged.
TEST(CircleErrors, OfADriveAloneHaveAllOfTheWindUpAndFewerCounts) {
  AxisConfig axis = Axis();
  EXPECT_NEAR(CircleErrorByDriveAlone_m(axis), 1e-6 + 3.0 * 5e-9, 1e-12);
  EXPECT_LT(CircleErrorByDrive_m(axis, ReportsAreNoise(axis, kPeriod_s)),
            0.3 * CircleErrorByDriveAlone_m(axis));
  axis.drive.encoder_counts_per_rev = 2500;
  EXPECT_LT(CircleErrorByDrive_m(axis, ReportsAreNoise(axis, kPeriod_s)), CircleErrorByDriveAlone_m(axis));
  axis.drive.encoder_counts_per_rev = 25000;
  axis.model.mechanics.screw_stiffness_N_um *= 3.0;
  EXPECT_GT(CircleErrorByDrive_m(axis, ReportsAreNoise(axis, kPeriod_s)),
            kModesDiffer * CircleErrorByDriveAlone_m(axis));
}

TEST(CircleErrors, OfTorquesFromHereGrowWithTheLoopsGivingWayAndFriction) {
  AxisConfig axis = Axis();
  EXPECT_NEAR(CircleErrorByTorque_m(axis, 0.25e-6), 0.06 * 40.0 * 0.25e-6, 1e-12);
  EXPECT_NEAR(UsualCircleErrorByTorque_m(axis), 0.5e-6 + 2.5 * 5e-9, 1e-12);
  axis.model.friction.Fc_plus_N = 130.0;
  EXPECT_NEAR(CircleErrorByTorque_m(axis, 0.25e-6), 0.06 * 80.0 * 0.25e-6, 1e-12);
  EXPECT_NEAR(UsualCircleErrorByTorque_m(axis), 1e-6 + 2.5 * 5e-9, 1e-12);
}

}  // namespace
}  // namespace contour
