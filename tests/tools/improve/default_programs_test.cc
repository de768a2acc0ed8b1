#include "tools/improve/default_programs.h"

#include <gtest/gtest.h>

#include "config/load_machine.h"
#include "daemon/program_limits.h"

namespace contour::improve {
namespace {

PerAxis<double> At(const MachineConfig& machine, double position_m) {
  PerAxis<double> at;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) at.push_back(position_m);
  return at;
}

/// Machines from a table of micrometres to a gantry, slow ones and such with little acceleration.
TEST(DefaultPrograms, FitWhateverTheLimitsAllow) {
  for (const char* file : {"/xy_emulated.yaml", "/single_axis.yaml"}) {
    for (const double acceleration : {50.0, 5000.0}) {
      for (const double travel_mm : {0.5, 6.0, 20.0, 300.0}) {
        for (const double speed_mm_s : {20.0, 100.0, 250.0}) {
          MachineConfig machine = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + file);
          for (auto& [name, axis] : machine.axes) axis.limits.acceleration_mm_s2 = acceleration;
          const std::string axis = machine.axes.begin()->first;
          const PerAxis<double> at = At(machine, 0.19);  // near an end
          const WorkingSpace space = SpaceFor(machine, axis, {travel_mm, speed_mm_s, 0.9}, at);
          const ProgramText path = UsualPath(machine, space), check = UsualCheck(machine, space);
          EXPECT_NE(path.text, check.text);
          for (const ProgramText& p : {path, check})
            EXPECT_NO_THROW(Place(p, space, ProgramLimits(machine), at))
                << file << " " << acceleration << " " << travel_mm << " " << speed_mm_s << "\n"
                << p.text;
        }
      }
    }
  }
}

TEST(DefaultPrograms, TheSpaceStaysInsideTheLimitsAndHasTheSameShareOfTorque) {
  MachineConfig machine = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml");
  machine.axes.at("y").limits.torque_Nm = 0.5;
  const WorkingSpace space = SpaceFor(machine, "x", {20.0, 50.0, 0.75}, At(machine, 0.199));
  EXPECT_NEAR(space.axes[0].high_m, 0.2, 1e-12);
  EXPECT_NEAR(space.axes[0].low_m, 0.18, 1e-12);
  EXPECT_NEAR(space.axes[1].max_torque_Nm, 0.25, 1e-12);
}

// Before: of a screw of 20 mm the path was nine tenths of a turn, and a cogging was not found.
TEST(DefaultPrograms, ASteepScrewIsGivenTurnsEnough) {
  MachineConfig machine = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/xy_emulated.yaml");
  for (auto& [name, axis] : machine.axes) {
    axis.model.mechanics.lead_mm = 20.0;
    axis.limits.position_mm = {-300.0, 300.0};
  }
  const CommissionLimits limits = UsualLimits(machine.axes.at("x"));
  EXPECT_DOUBLE_EQ(limits.travel_mm, 60.0);
  const WorkingSpace space = SpaceFor(machine, "x", limits, At(machine, 0.0));
  EXPECT_NE(UsualPath(machine, space).text.find("radius_mm: 20.0"), std::string::npos);
  // As far as the stroke has them, its very ends apart.
  machine.axes.at("x").limits.position_mm = {-20.0, 20.0};
  EXPECT_DOUBLE_EQ(UsualLimits(machine.axes.at("x")).travel_mm, 38.0);
  // A fine one keeps what commissioning has.
  machine.axes.at("x").limits.position_mm = {-100.0, 100.0};
  machine.axes.at("x").model.mechanics.lead_mm = 5.0;
  EXPECT_DOUBLE_EQ(UsualLimits(machine.axes.at("x")).travel_mm,
                   DefaultCommissionLimits(machine.axes.at("x")).travel_mm);
}

}  // namespace
}  // namespace contour::improve
