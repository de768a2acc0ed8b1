#include "tools/machine/stated_machine.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tools/machine/load_emulated_machine.h"

namespace contour {
namespace {

MachineConfig Machine(const std::vector<std::string>& set) {
  return LoadEmulatedMachine(std::string(CONTOUR_CONFIG_DIR) + "/family/base.yaml", set).machine;
}

// One axis that is hardly known says nothing of the others.
TEST(StatedMachine, EachAxisIsOffByWhatIsNotKnownOfIt) {
  const MachineConfig machine = Machine({"axes.x.model.uncertainty.table_mass_kg=0.6"});
  const EmulatorConfig stated = StatedMachine(machine), lighter = StatedMachine(machine, {.inertia = -1.0}),
                       stiffer = StatedMachine(machine, {.stiffness = 1.0});
  const auto mass = [](const EmulatorConfig& e, const char* axis) { return e.axes.at(axis).table_mass_kg; };
  EXPECT_EQ(mass(stated, "x"), machine.axes.at("x").model.mechanics.table_mass_kg);
  EXPECT_NEAR(mass(stated, "x") / mass(lighter, "x"), 1.6, 1e-9);
  EXPECT_NEAR(mass(stated, "y") / mass(lighter, "y"), 1.058, 1e-9);
  EXPECT_EQ(mass(stated, "x"), mass(stiffer, "x"));
  EXPECT_NEAR(stiffer.axes.at("y").screw_stiffness_N_um / stated.axes.at("y").screw_stiffness_N_um, 1.12,
              1e-9);
}

// The emulated axis has its bumpers as far below zero as above.
TEST(StatedMachine, StandsBetweenItsBumpers) {
  for (const char* limits : {"[-200, 200]", "[100, 400]", "[-1000, -600]"}) {
    const MachineConfig machine = Machine({std::string("axes.x.limits.position_mm=") + limits});
    const auto [low_mm, high_mm] = machine.axes.at("x").limits.position_mm;
    const EmulatedAxisConfig axis = StatedMachine(machine).axes.at("x");
    EXPECT_EQ(axis.start_position_mm, 0.5 * (low_mm + high_mm)) << limits;
    EXPECT_LE(-0.5 * axis.stroke_mm, low_mm) << limits;
    EXPECT_GE(0.5 * axis.stroke_mm, high_mm) << limits;
  }
}

// A controller that leads a cogging swings an axis that has none.
TEST(StatedMachine, CogsAsTheModelDoes) {
  const MachineConfig machine =
      Machine({"axes.x.model.extensions={cogging: {amplitude_Nm: 0.06, order_per_rev: 6, phase_rad: 0.3, "
               "further: [{amplitude_Nm: 0.02, order_per_rev: 12, phase_rad: 0}]}, torque_constant: {ratio: "
               "1.2}}"});
  const EmulatorConfig stated = StatedMachine(machine);
  EXPECT_FALSE(stated.axes.at("y").effects.cogging);
  const auto& cogging = stated.axes.at("x").effects.cogging;
  ASSERT_TRUE(cogging);
  EXPECT_NEAR(cogging->amplitude_Nm, 0.05, 1e-12);
  EXPECT_EQ(cogging->order_per_rev, 6.0);
  EXPECT_EQ(cogging->phase_rad, 0.3);
  ASSERT_EQ(cogging->further.size(), 1u);
  EXPECT_EQ(cogging->further[0].order_per_rev, 12.0);
}

}  // namespace
}  // namespace contour
