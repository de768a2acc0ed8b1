#include "tools/plant_emulator/emulated_machine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/plant_emulator/drive_harness.h"

namespace contour::test {
namespace {

TEST(EmulatedMachine, MovesTheWayTheTorquePushes) {
  DriveHarness h(NominalMachine(), {Place("x", 1), Place("y", 2)});
  h.BringUp();
  h.Enable();
  ASSERT_EQ(h.status(1) & 0x6F, 0x27);
  ASSERT_EQ(h.status(2) & 0x6F, 0x27);
  const AxisTruth before = h.machine.truth().axes[0];
  for (int k = 0; k < 200; ++k) h.Cycle(0x0F, 150);
  const AxisTruth& after = h.machine.truth().axes[0];
  EXPECT_GT(after.table_position_m, before.table_position_m + 1e-3);
  EXPECT_GT(after.friction_N, 0.0);
  EXPECT_NEAR(after.torque_Nm, 0.150 * 0.637, 1e-6);
}

TEST(EmulatedMachine, SyncNumberNFallsOnPlantTimeNPeriods) {
  DriveHarness h(NominalMachine(), {Place("x", 1), Place("y", 2)});
  h.BringUp();
  for (int k = 0; k < 7; ++k) h.Cycle(0x06);
  EXPECT_EQ(h.machine.truth().sync_number, 7U);
  EXPECT_DOUBLE_EQ(h.machine.truth().time_s, 0.007);
}

TEST(EmulatedMachine, RefusesWhatItCannotEmulate) {
  const std::vector<EmulatedAxisPlacement> x{Place("x", 1)};
  EXPECT_THROW(EmulatedMachine(NominalMachine(), std::vector{Place("z", 1)}, 1000), std::invalid_argument);
  EXPECT_THROW(EmulatedMachine(NominalMachine(), std::vector{Place("x", 0)}, 1000), std::invalid_argument);
  EXPECT_THROW(EmulatedMachine(NominalMachine(), std::vector{Place("x", 1), Place("y", 1)}, 1000),
               std::invalid_argument);
  EmulatorConfig bad = NominalMachine();
  bad.axes["x"].friction.Fs_plus_N = 1.0;
  EXPECT_THROW(EmulatedMachine(bad, x, 1000), std::invalid_argument);
  EmulatorConfig coupled = NominalMachine();
  coupled.axes["x"].effects.cross_coupling = CrossCouplingEffect{"nowhere", 1e-4};
  EXPECT_THROW(EmulatedMachine(coupled, x, 1000), std::invalid_argument);
}

}  // namespace
}  // namespace contour::test
