#include "tools/faults/machine_in_mode.h"

#include <gtest/gtest.h>

#include "config/friction_choice.h"
#include "tools/faults/fault_run.h"

namespace contour::faults {
namespace {

// Before: of a file that states csp the campaign changed the mode alone, and the filter ran in torque mode,
// where contourd would not have had it (3 of 300 runs of a machine of 17 bit failed, two before any fault).
TEST(MachineInMode, HasTheFrictionLawOfThatMode) {
  const std::string path = std::string(CONTOUR_CONFIG_DIR) + "/family/base.yaml";
  const EmulatedMachineFile stated = LoadEmulatedMachine(path);
  for (const DriveMode mode : {DriveMode::kCst, DriveMode::kCsp}) {
    const EmulatedMachineFile file = MachineInMode(path, stated, mode);
    for (const auto& [name, axis] : file.machine.axes) {
      EXPECT_EQ(axis.drive.mode, mode) << name;
      // The linear law holds an axis by its own loop in torque mode alone.
      if (mode == DriveMode::kCst && file.machine.control.friction == FrictionKind::kLinear) {
        EXPECT_TRUE(axis.loop) << name;
      }
    }
    EXPECT_EQ(file.machine.control.friction, ChooseFriction(file.machine)) << Name(mode);
  }
}

TEST(MachineInMode, ARunTakesTheOneOfItsMode) {
  EmulatedMachineFile cst, csp;
  RunRequest request{&cst};
  EXPECT_EQ(&request.In(DriveMode::kCsp), &cst);
  request.in_csp = &csp;
  EXPECT_EQ(&request.In(DriveMode::kCsp), &csp);
  EXPECT_EQ(&request.In(DriveMode::kCst), &cst);
}

}  // namespace
}  // namespace contour::faults
